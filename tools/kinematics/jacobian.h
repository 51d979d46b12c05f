// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/kinematics/types.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine.h"

namespace vernier::kinematics {

/// Returns the difference target - pose for state i. The first three values are lengths (mm). Depending on
/// `match`, there follow no values, two tilts of the tool's z axis about perpendicular directions, or the
/// rotation vector. Rotations in the difference are multiplied by lever_mm.
Eigen::VectorXd pose_error(const model::Poses& poses, const model::Poses& target, std::size_t i, Match match,
                           double lever_mm);

/// Returns the decrease of pose_error per mm or deg of each axis, one matrix for each state. The Jacobian is
/// computed by central differences of the forward kinematics. For the central differences, one axis at a
/// time is moved in all states together.
std::vector<Eigen::MatrixXd> axis_jacobian(const model::Machine& machine, const model::States& states,
                                           const std::vector<std::size_t>& axes, Match match,
                                           double lever_mm);

/// Returns the unit of each axis for the scaled Jacobian: 1 mm for a linear axis, 1 rad / lever for a rotary
/// axis (in deg). With these units, the columns of linear and rotary axes have similar size.
Eigen::VectorXd axis_scales(const model::Machine& machine, const std::vector<std::size_t>& axes,
                            double lever_mm);

/// Returns the condition number of the scaled Jacobian: its largest singular value divided by the smallest
/// singular value of full rank. The condition number is infinite if the smallest singular value is 0, or if
/// there are fewer axes than conditions.
double condition_of(const Eigen::MatrixXd& jacobian, const model::Machine& machine,
                    const std::vector<std::size_t>& axes, const InverseOptions& options);

/// Returns the length of the part of `residual` that the axes can remove. Singular values below 1 /
/// most_condition of the largest are ignored.
double reducible(const Eigen::MatrixXd& jacobian, const model::Machine& machine,
                 const std::vector<std::size_t>& axes, const Eigen::VectorXd& residual,
                 const InverseOptions& options);

}  // namespace vernier::kinematics
