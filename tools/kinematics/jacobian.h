// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/kinematics/types.h"
#include "tools/model/chain.h"
#include "tools/model/machine.h"

namespace vernier::kinematics {

/// target - pose of state i: three lengths (mm), then by `match` nothing, two tilts of the tool's z axis
/// about directions across it, or the rotation vector; rotations times lever_mm. tool.
Eigen::VectorXd pose_error(const model::Poses& poses, const model::Poses& target, std::size_t i, Match match,
                           double lever_mm);

/// How pose_error would shrink per mm or deg of each axis, one matrix a state: central differences of the
/// forward solution, an axis moved in all states at once. tool.
std::vector<Eigen::MatrixXd> axis_jacobian(const model::Machine& machine, const model::States& states,
                                           const std::vector<std::size_t>& axes, Match match,
                                           double lever_mm);

/// What one unit of each axis is in the scaled Jacobian: 1 mm for a linear axis, 1 rad / lever for a rotary
/// one (in deg), so that both kinds of columns are of like size.
Eigen::VectorXd axis_scales(const model::Machine& machine, const std::vector<std::size_t>& axes,
                            double lever_mm);

/// Ratio of the largest singular value of the scaled Jacobian to the one that a full rank needs; infinite
/// where that is 0 or there are fewer axes than conditions. tool.
double condition_of(const Eigen::MatrixXd& jacobian, const model::Machine& machine,
                    const std::vector<std::size_t>& axes, const InverseOptions& options);

/// Length of the part of `residual` that lies in the reach of the axes (singular values below
/// 1 / most_condition of the largest do not count). tool.
double reducible(const Eigen::MatrixXd& jacobian, const model::Machine& machine,
                 const std::vector<std::size_t>& axes, const Eigen::VectorXd& residual,
                 const InverseOptions& options);

}  // namespace vernier::kinematics
