// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

namespace vernier::maths {

/// A rigid motion: point -> rotation * point + translation.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

/// Returns the rotation matrix of a rotation vector, rad.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& vector);

/// Returns the rigid motion that brings the points `from` closest to the points `to`, in the sum of squared
/// distances. `from`, `to`: corresponding points, 3 x N, N >= 1. If all points are on one line, they do not
/// determine the rotation about this line. If the rotation about a line of points is not determined, the
/// smallest rotation is used. For a single point the rotation is zero. The method is that of Umeyama, IEEE
/// PAMI 13 (1991) 376, equations 40-43, without scale.
RigidMotion align(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

/// True if the points (3 x N) determine a rigid motion: three of the points are not on one line (within 1e-9
/// of their extent).
bool fixes_motion(const Eigen::Matrix3Xd& points);

/// Returns the difference between the moved points and `to`, after the motion is applied to `from`.
Eigen::Matrix3Xd aligned_error(const RigidMotion& motion, const Eigen::Matrix3Xd& from,
                               const Eigen::Matrix3Xd& to);

}  // namespace vernier::maths
