// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/map/field.h"

namespace vernier::map {

/// Result of a simulated measurement along a straight line, forward and backward. The deviations are along
/// the line from its first point, um.
struct LineResult {
  std::string name;
  Eigen::Vector3d from, to;         // nominal end points of the line, mm
  std::vector<double> distance_mm;  // distance of each position from the first position
  std::vector<double> forward_um, reverse_um;
  double error_um = 0;         // E: range of the deviations in both directions
  double mean_um = 0;          // M: range of the mean of both directions
  double reversal_um = 0;      // B: largest difference between the two directions
  double straightness_um = 0;  // range perpendicular to the line, relative to its least-squares line; the
                               // larger value of two perpendicular directions
};

constexpr int kLinePositions = 21;  // number of positions on a line, at a distance of one twentieth of its
                                    // length

/// Simulates the measurement of a line with `positions` points between two nominal points, forward and then
/// backward. The definitions of E, M, B are those of ISO 230-6 (diagonals) and ISO 230-2 (single axes). In
/// this simulation each direction has one run. Because each direction has one run, the simulation gives no
/// repeatability.
LineResult measure_line(const Bench& bench, const std::string& name, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& to, int positions = kLinePositions);

/// axis_lines returns the results for lines along each linear axis through the middle of the volume.
/// diagonals returns the results for body diagonals (four) and face diagonals (two in each face at the low
/// end of the third axis; with two axes, the two diagonals of the plane). The names of the lines are "X",
/// "+X+Y-Z", "+X-Y". A line that the nominal chain cannot follow is not in the result.
std::vector<LineResult> axis_lines(const model::Machine& machine, const Bench& bench);
std::vector<LineResult> diagonals(const model::Machine& machine, const Bench& bench);

/// Returns the ISO 230-4 results of simulated circular tests as JSON. The circles are in the planes XY, YZ,
/// ZX of the workpiece about the middle of the volume, in both directions, with the largest possible radius.
/// A plane that the axes cannot reach is not in the result.
nlohmann::ordered_json circles_json(const Bench& bench);
/// Returns the results for simulated squares in the planes XY, YZ, ZX as JSON: angle of the sides (um/m from
/// 90 deg), side lengths, straightness.
nlohmann::ordered_json squares_json(const Bench& bench);
/// Returns the results for a simulated cylinder (five circles along Z) as JSON: range of the radii about its
/// least-squares axis, and tilt of this axis. The function cylinder_json() returns null if the axes cannot
/// reach the circles.
nlohmann::ordered_json cylinder_json(const Bench& bench);
/// Returns the results for lines through the points of a CSV file `x[mm],y[mm],z[mm],run` as JSON, one line
/// for each run: length between the ends of the line, and straightness. Throws InputError if a point is
/// outside the volume, or if a run has fewer than two points.
nlohmann::ordered_json free_lines_json(const Bench& bench, const std::string& path);

nlohmann::ordered_json line_json(const LineResult& line);

}  // namespace vernier::map
