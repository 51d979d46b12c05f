// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

namespace vernier::maths {

/// A rigid motion: point -> rotation * point + translation.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

/// Returns the rotation of a rotation vector, rad.
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& vector);

/// Returns the rigid motion that brings `from` closest to `to` in the sum of squared distances. from, to: 3 x
/// N, N >= 1, in correspondence. Points on one line do not determine the rotation about the line: the
/// smallest rotation is used. For a single point the rotation is zero. Source: Umeyama, IEEE PAMI 13 (1991)
/// 376, equations 40-43, without scale.
RigidMotion align(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

/// True if points (3 x N) determine a rigid motion: three of them are not on one line (to 1e-9 of their
/// extent).
bool fixes_motion(const Eigen::Matrix3Xd& points);

/// Returns the motion applied to `from`, minus `to`.
Eigen::Matrix3Xd aligned_error(const RigidMotion& motion, const Eigen::Matrix3Xd& from,
                               const Eigen::Matrix3Xd& to);

}  // namespace vernier::maths
