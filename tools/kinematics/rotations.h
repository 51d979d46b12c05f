// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

namespace vernier::kinematics {

/// Returns the rotation vector of a rotation matrix, rad.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation);
/// Returns the rotation matrix of a rotation vector, deg.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& vector_deg);

}  // namespace vernier::kinematics
