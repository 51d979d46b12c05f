// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/map/field.h"

namespace vernier::map {

/// A straight line measured forward and back; deviations along the line from its first point, um.
struct LineResult {
  std::string name;
  Eigen::Vector3d from, to;         // nominal ends, mm
  std::vector<double> distance_mm;  // of the positions, from the first
  std::vector<double> forward_um, reverse_um;
  double error_um = 0;     // E: range over both directions
  double mean_um = 0;      // M: range of the mean of both directions
  double reversal_um = 0;  // B: largest difference of the directions
  double straightness_um =
      0;  // range across the line about its least-squares line, the larger one of two directions
};

constexpr int kLinePositions = 21;  // of a line: every twentieth of it

/// Measures a line of `positions` points between two nominal points, forward then back. Source of E, M, B:
/// ISO 230-6 (diagonals), ISO 230-2 (single axes). Here each direction has one run, and therefore there is no
/// repeatability.
LineResult measure_line(const Bench& bench, const std::string& name, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& to, int positions = kLinePositions);

/// axis_lines: each linear axis through the middle of the volume. diagonals: body diagonals (four) and face
/// diagonals (two in each face at the low end of the third axis; with two axes the two of the plane). Names:
/// "X", "+X+Y-Z", "+X-Y". A line that the nominal chain cannot follow is omitted.
std::vector<LineResult> axis_lines(const model::Machine& machine, const Bench& bench);
std::vector<LineResult> diagonals(const model::Machine& machine, const Bench& bench);

/// Returns ISO 230-4 results of circles in the planes XY, YZ, ZX of the workpiece about the middle
/// of the volume, in both directions, with the largest possible radius. Planes that the axes
/// cannot reach are omitted.
nlohmann::ordered_json circles_json(const Bench& bench);
/// Returns results of squares in the planes XY, YZ, ZX: angle of the sides (um/m from 90 deg), side lengths,
/// straightness.
nlohmann::ordered_json squares_json(const Bench& bench);
/// Returns results of a cylinder (five circles along Z): range of the radii about its least-squares axis,
/// tilt of that axis; null if the axes cannot reach the circles.
nlohmann::ordered_json cylinder_json(const Bench& bench);
/// Returns results of lines through points of a CSV file `x[mm],y[mm],z[mm],run`, one line per run: length
/// between the ends of the line, and straightness. Throws InputError: a point outside the volume, fewer than
/// two points.
nlohmann::ordered_json free_lines_json(const Bench& bench, const std::string& path);

nlohmann::ordered_json line_json(const LineResult& line);

}  // namespace vernier::map
