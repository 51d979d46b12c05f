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

/// One run of a circular test in a measurement: its observations and their angles.
struct CircleRun {
  std::string label;
  int direction = +1;
  std::vector<std::size_t> observation;  // indices into Measurement::observations, in time order
  std::vector<double> angle_deg;         // angle of the nominal tool point about the centre, 0..360
};

/// Runs with length observations on one circle: they have the same centre, nominal radius and plane.
struct Circle {
  std::array<std::size_t, 2> plane{0, 1};  // coordinates 0..2 of the plane: (X,Y), (Y,Z) or (Z,X)
  std::array<double, 3> centre_mm{};
  double nominal_radius_mm = 0;
  std::vector<CircleRun> runs;
};

/// Finds the circular tests (ball bar) in a measurement. In a run of a circular test, lengths are measured
/// while the nominal tool point moves on a circle about the centre of the length. The circle is in a
/// coordinate plane, and the motion covers at least 90 degrees.
std::vector<Circle> find_circles(const model::Machine& machine, const model::Measurement& measurement);

/// Analyses the fit rows of a circle by ISO 230-4. (Check rows are overshoot arcs or held-out rows.) Throws
/// std::invalid_argument if a run has too few fit rows.
importer::CircularResult analyse(const Circle& circle, const model::Measurement& measurement);

}  // namespace vernier::results
