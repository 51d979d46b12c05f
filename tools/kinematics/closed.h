// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>

#include "tools/kinematics/inverse.h"

namespace vernier::kinematics {

/// Closed-form inverse solution for a chain whose tool point is an affine function of its linear axes: p =
/// origin + jacobian * q. The closed-form solution is exact for the motion and the inputs of the state for
/// which it was made.
struct ClosedSolution {
  std::vector<std::size_t> axes;  // the linear axes, which are the columns of the Jacobian
  Eigen::Vector3d origin;         // tool point with the linear axes at 0, mm
  Eigen::Matrix3Xd jacobian;      // mm per mm, equal at every position
  double condition = 0;           // condition number of the Jacobian
};

/// Returns the closed-form solution, or nullopt if the chain has no such solution. Whether a closed-form
/// solution exists is decided from the expressions of the chain, not from samples. First condition for a
/// closed-form solution: every rotation is independent of the linear axes. Second condition for a
/// closed-form solution: every length is at most of first degree in the linear axes. Third condition for a
/// closed-form solution: the tables of the linear axes are zero. Fourth condition for a closed-form
/// solution: there are one to three linear axes, and their directions are independent. `at`: one state with
/// the positions of the rotary and fixed axes, the motion and the inputs.
std::optional<ClosedSolution> closed_solution(const model::Machine& machine, const model::States& at);

/// Returns the positions of the linear axes for tool points (3 x N, mm), one column for each point. With
/// fewer than three linear axes, the result is the positions with the nearest tool points.
Eigen::MatrixXd solve_closed(const ClosedSolution& solution, const Eigen::Matrix3Xd& points);

}  // namespace vernier::kinematics
