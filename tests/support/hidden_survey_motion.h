// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/hidden_survey_family.h"

namespace vernier::support {

/// How the machine is measured.
enum class Manner : std::uint8_t {
  kAtRest,   // moves to a pose, stops, is read
  kMoving,   // read on the fly: lines with acceleration, arcs where two linear axes span a plane
  kProbing,  // touches surfaces along their normal and is latched while it moves
};
/// kDirection: of the tool's z axis, two angles; kTurn: about z, an autocollimator on a polygon.
enum class Reading : std::uint8_t { kPoint, kLength, kD, kX, kZ, kDirection, kTurn };
constexpr bool is_angular(Reading reading) {
  return reading == Reading::kDirection || reading == Reading::kTurn;
}
/// What a length at the end of one metre is as an angle: the uncertainty of an angular reading.
constexpr double angle_deg(double length_mm) { return length_mm / 1000 * 180 / std::numbers::pi; }
constexpr bool is_by_direction(Family family) {
  return family == Family::kAltAz || family == Family::kEquatorial;
}

struct MotionOptions {
  Manner manner = Manner::kAtRest;
  Reading reading = Reading::kPoint;
  std::size_t rows = 400, runs = 4;
  int feeds = 3;
  bool locked = false;       // the first axis only creeps forward within a run: time and place go together
  bool one_axis = false;     // one axis moves at a time, read at constant speed
  bool one_thermal = false;  // every thermometer shows one shape, in proportion to the time
};

/// One row of a survey: commanded state, physically consistent with the rows before it.
struct MotionRow {
  std::vector<double> q, v, a, direction, since;  // by axis: mm, mm/s, mm/s^2, -1 0 1, mm (deg)
  double feed = 0, curvature = 0, t = 0;          // mm/min, 1/mm, s
  std::array<double, 3> normal{}, centre{};
  std::size_t run = 0;
  bool check = false;
};

std::vector<MotionRow> move(const Geometry& geometry, const MotionOptions& options, Draw& draw);

/// The multiple of the step that is nearest.
double to_step(double value, double step);

/// Label of a run.
std::string run_label(std::size_t run);

}  // namespace vernier::support
