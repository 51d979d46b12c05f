// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/chain.h"
#include "tools/model/machine.h"
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
const char* name_of(InverseFault fault);

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

/// Newton iteration with damping (Levenberg-Marquardt, Marquardt 1963) on the forward solution, for all
/// states at once. A rotary axis is turned by whole turns into its range; the proof is of what is returned.
/// `target`: one pose a state, workpiece coordinates (rotation unused for kPosition).
/// `start`: first guess, and motion, inputs, runs and time as they are. Jacobian by central differences, so
/// that every expression of the chain counts. Throws InputError where the chain is not finite. tool.
InverseResult solve(const model::Machine& machine, const model::Poses& target, const model::States& start,
                    const InverseOptions& options);

/// The same for one pose from many places: `start` first, then up to `restarts` starts spread over the axis
/// ranges (Halton sequence, the same every time). The first solution within the ranges, else the best
/// failure. Axes without min and max keep their start. tool.
InverseResult solve_anywhere(const model::Machine& machine, const model::Poses& target,
                             const model::States& start, const InverseOptions& options, int restarts);

/// Axes of `machine` that are linear, in order.
std::vector<std::size_t> linear_axes(const model::Machine& machine);

/// Rotation vector of a matrix, rad.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation);
/// Matrix of a rotation vector, deg.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& vector_deg);

}  // namespace vernier::kinematics
