// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/kinematics/types.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine.h"

namespace vernier::kinematics {

/// Returns target - pose of state i. Three lengths (mm); then, depending on `match`, nothing, two tilts of
/// the tool's z axis about directions across it, or the rotation vector. Rotations are multiplied by
/// lever_mm.
Eigen::VectorXd pose_error(const model::Poses& poses, const model::Poses& target, std::size_t i, Match match,
                           double lever_mm);

/// Returns the decrease of pose_error per mm or deg of each axis, one matrix per state, by central
/// differences of the forward kinematics. An axis is moved in all states together.
std::vector<Eigen::MatrixXd> axis_jacobian(const model::Machine& machine, const model::States& states,
                                           const std::vector<std::size_t>& axes, Match match,
                                           double lever_mm);

/// Returns the unit of each axis in the scaled Jacobian: 1 mm for a linear axis, 1 rad / lever for a rotary
/// axis (in deg). Both kinds of columns then have similar size.
Eigen::VectorXd axis_scales(const model::Machine& machine, const std::vector<std::size_t>& axes,
                            double lever_mm);

/// Returns the ratio of the largest singular value of the scaled Jacobian to the smallest singular value of a
/// full rank. The ratio is infinite if the smallest value is 0, or if there are fewer axes than conditions.
double condition_of(const Eigen::MatrixXd& jacobian, const model::Machine& machine,
                    const std::vector<std::size_t>& axes, const InverseOptions& options);

/// Returns the length of the part of `residual` that the axes can reach (singular values below 1 /
/// most_condition of the largest do not count).
double reducible(const Eigen::MatrixXd& jacobian, const model::Machine& machine,
                 const std::vector<std::size_t>& axes, const Eigen::VectorXd& residual,
                 const InverseOptions& options);

}  // namespace vernier::kinematics
