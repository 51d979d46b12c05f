// SPDX-License-Identifier: GPL-3.0-or-later
// What an inverse solution is asked for and its proof: values, no algorithm.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tools/model/states.h"

namespace vernier::kinematics {

/// What of a pose has to be met: the tool point; the point and the direction of the tool's z axis; all of it.
enum class Match : std::uint8_t { kPosition, kDirection, kPose };

/// Why a solution was not found.
enum class InverseFault : std::uint8_t {
  kNone,
  kSingular,     // axes have lost a degree of freedom there: the axis values are not determined
  kUnreachable,  // no step makes the residual smaller, yet the axes still move the tool every way
  kBeyondRange,  // solved, but an axis would have to stand outside its min..max
};

struct InverseOptions {
  Match match = Match::kPose;
  std::vector<std::size_t> axes;  // that may move, indices into Machine::axes; empty: all
  int most_iterations = 60;
  double tolerance_mm = 1e-9, tolerance_deg = 1e-9;
  /// Weight of a rotation against a length in the damped step and in the condition number, mm per rad.
  double lever_mm = 300;
  /// Beyond this condition number of the Jacobian a pose counts as singular.
  double most_condition = 1e6;
  bool keep_ranges = true;
  /// Least squares in the directions that the axes can move; what they cannot reach stays as residual.
  bool only_reachable = false;
};

/// The proof of one solution: forward solution of the axes found, against the target.
struct Inverse {
  bool converged = false;
  InverseFault fault = InverseFault::kNone;
  int iterations = 0;
  double residual_mm = 0, residual_deg = 0;  // of what `match` asks for
  double reducible_mm = 0;  // part of it that the axes could still take away (rotations * lever)
  double condition = std::numeric_limits<double>::infinity();  // of the scaled Jacobian there
  std::size_t axis = 0;                                        // kBeyondRange: which
};

struct InverseResult {
  model::States states;  // the start states with the axes found
  std::vector<Inverse> each;
};

}  // namespace vernier::kinematics
