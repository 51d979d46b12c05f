// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>

#include "tools/kinematics/inverse.h"

namespace vernier::kinematics {

/// Closed solution of a chain whose tool point is an affine function of its linear axes:
/// p = origin + jacobian * q, exactly, whatever the motion and inputs of the one state it was made at.
struct ClosedSolution {
  std::vector<std::size_t> axes;  // the linear axes, columns of the Jacobian
  Eigen::Vector3d origin;         // mm, with those axes at 0
  Eigen::Matrix3Xd jacobian;      // mm per mm, the same at every position
  double condition = 0;           // of the Jacobian
};

/// The closed solution, or nothing where the chain has none. Decided from the expressions, not from samples:
/// every rotation is free of the linear axes, every length is at most of first degree in them, tables of them
/// are zero, and there are one to three of them, independent. `at`: the one state (count 1) that gives the
/// other axes, motion and inputs. tool.
std::optional<ClosedSolution> closed_solution(const model::Machine& machine, const model::States& at);

/// Linear axis positions for tool points (3 x N, mm), as columns. With fewer than three axes: the nearest
/// ones.
Eigen::MatrixXd solve_closed(const ClosedSolution& solution, const Eigen::Matrix3Xd& points);

}  // namespace vernier::kinematics
