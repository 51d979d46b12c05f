// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/kinematics/rotations.h"

#include <Eigen/Geometry>
#include <cmath>

#include "tools/maths/factors.h"

namespace vernier::kinematics {

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  // Through the quaternion: well conditioned near 0 and near half a turn.
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-300) return Eigen::Vector3d::Zero();
  return q.vec() * (2 * std::atan2(sine, q.w()) / sine);
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& vector_deg) {
  const double angle = vector_deg.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle / maths::kDegPerRad, vector_deg / angle).toRotationMatrix();
}

}  // namespace vernier::kinematics
