// SPDX-License-Identifier: GPL-3.0-or-later
// What an inverse solution is asked for and its proof: values, no algorithm.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tools/model/states.h"

namespace vernier::kinematics {

/// Part of a pose that must be reached: the tool point; the point and the direction of the tool's
/// z axis; the whole pose.
enum class Match : std::uint8_t { kPosition, kDirection, kPose };

/// Reason why a solution was not found.
enum class InverseFault : std::uint8_t {
  kNone,
  kSingular,     // axes have lost a degree of freedom there, so their positions are not determined
  kUnreachable,  // no step reduces the residual, although the axes still move the tool in all directions
  kBeyondRange,  // solved, but an axis would be outside its min..max
};

struct InverseOptions {
  Match match = Match::kPose;
  std::vector<std::size_t> axes;  // that may move, indices into Machine::axes; empty: all
  int most_iterations = 60;
  double tolerance_mm = 1e-9, tolerance_deg = 1e-9;
  /// Weight of a rotation against a length in the damped step and in the condition number, mm per rad.
  double lever_mm = 300;
  /// Condition number of the Jacobian above which a pose counts as singular.
  double most_condition = 1e6;
  bool keep_ranges = true;
  /// Least squares in the directions that the axes can move. The other components remain as
  /// residual.
  bool only_reachable = false;
};

/// Verification of one solution: forward kinematics of the found axes, compared with the target.
struct Inverse {
  bool converged = false;
  InverseFault fault = InverseFault::kNone;
  int iterations = 0;
  double residual_mm = 0, residual_deg = 0;  // of the part that `match` requires
  double reducible_mm = 0;  // part of it that the axes could still remove (rotations * lever)
  double condition = std::numeric_limits<double>::infinity();  // of the scaled Jacobian there
  std::size_t axis = 0;                                        // kBeyondRange: the axis
};

struct InverseResult {
  model::States states;  // the start states with the found axes
  std::vector<Inverse> each;
};

}  // namespace vernier::kinematics
