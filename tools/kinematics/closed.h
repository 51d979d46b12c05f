// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>

#include "tools/kinematics/inverse.h"

namespace vernier::kinematics {

/// Closed solution of a chain whose tool point is an affine function of its linear axes: p = origin +
/// jacobian * q. The solution is exact for the motion and inputs of the state from which it was made.
struct ClosedSolution {
  std::vector<std::size_t> axes;  // the linear axes, columns of the Jacobian
  Eigen::Vector3d origin;         // mm, with those axes at 0
  Eigen::Matrix3Xd jacobian;      // mm per mm, the same at every position
  double condition = 0;           // of the Jacobian
};

/// Returns the closed solution, or nullopt if the chain has no closed solution. The decision uses the
/// expressions, not samples. Condition 1: every rotation is independent of the linear axes. Condition 2:
/// every length is at most of first degree in the linear axes. Condition 3: the tables of the linear axes are
/// zero. Condition 4: there are one to three linear axes, and they are independent. `at`: one state (count 1)
/// that gives the other axes, motion and inputs.
std::optional<ClosedSolution> closed_solution(const model::Machine& machine, const model::States& at);

/// Returns linear axis positions for tool points (3 x N, mm), as columns. With fewer than three linear axes,
/// solve_closed returns the nearest positions.
Eigen::MatrixXd solve_closed(const ClosedSolution& solution, const Eigen::Matrix3Xd& points);

}  // namespace vernier::kinematics
