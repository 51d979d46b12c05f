// SPDX-License-Identifier: GPL-3.0-or-later
// Options of an inverse solution, and the verification of its result; this file contains only data types.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tools/model/states.h"

namespace vernier::kinematics {

/// Part of a pose that must be reached: the tool point; the tool point and the direction of the tool's z
/// axis; or the whole pose.
enum class Match : std::uint8_t { kPosition, kDirection, kPose };

/// Reason why a solution was not found.
enum class InverseFault : std::uint8_t {
  kNone,
  kSingular,     // the axes have lost a degree of freedom at this pose, so that their positions are not
                 // determined
  kUnreachable,  // no step reduces the residual, although the axes can still move the tool in all directions
  kBeyondRange,  // there is a solution, but an axis would be outside its range min..max
};

struct InverseOptions {
  Match match = Match::kPose;
  std::vector<std::size_t> axes;  // indices into Machine::axes of the axes that may move; empty: all axes
  int most_iterations = 60;
  double tolerance_mm = 1e-9, tolerance_deg = 1e-9;
  /// Weight of a rotation relative to a length, in the damped step and in the condition number, mm per rad.
  double lever_mm = 300;
  /// Condition number of the Jacobian above which a pose counts as singular.
  double most_condition = 1e6;
  bool keep_ranges = true;
  /// True: least squares in the directions in which the axes can move the tool. With least squares, the
  /// components in other directions remain as residual.
  bool only_reachable = false;
};

/// Verification of one solution. The forward kinematics of the found axis positions are compared with the
/// target.
struct Inverse {
  bool converged = false;
  InverseFault fault = InverseFault::kNone;
  int iterations = 0;
  double residual_mm = 0, residual_deg = 0;  // residual of the part of the pose that `match` requires
  double reducible_mm = 0;  // part of the residual that the axes could still remove (rotations * lever)
  double condition = std::numeric_limits<double>::infinity();  // condition number of the scaled Jacobian at
                                                               // the solution
  std::size_t axis = 0;                                        // for kBeyondRange: index of the axis
};

struct InverseResult {
  model::States states;  // the start states with the found axis positions
  std::vector<Inverse> each;
};

}  // namespace vernier::kinematics
