// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "tools/import/ballbar/circular.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::results {

/// One run of a circular test in a measurement: the observations and their angles.
struct CircleRun {
  std::string label;
  int direction = +1;
  std::vector<std::size_t> observation;  // indices into Measurement::observations, in time order
  std::vector<double> angle_deg;         // of the nominal tool point about the centre, 0..360
};

/// Runs of length observations on one circle: same centre, same nominal radius, same plane.
struct Circle {
  std::array<std::size_t, 2> plane{0, 1};  // coordinates 0..2 of the plane: (X,Y), (Y,Z) or (Z,X)
  std::array<double, 3> centre_mm{};
  double nominal_radius_mm = 0;
  std::vector<CircleRun> runs;
};

/// Finds the circular tests (ball bar) in a measurement. In such a run, lengths are measured while the
/// nominal tool point moves over at least 90 degrees on a circle in a coordinate plane about the length's
/// centre.
std::vector<Circle> find_circles(const model::Machine& machine, const model::Measurement& measurement);

/// ISO 230-4 analysis of a circle's fit rows (check rows are overshoot or held out). Throws
/// std::invalid_argument if a run has too few fit rows.
importer::CircularResult analyse(const Circle& circle, const model::Measurement& measurement);

}  // namespace vernier::results
