// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/alignment.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace vernier::maths {
namespace {

/// Below this share of the largest extent a second extent is rounding: mm^2 over mm^2.
constexpr double kFlat = 1e-14;

Eigen::Matrix3d rotation_of(const Eigen::Matrix3d& covariance, double extent) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& size = svd.singularValues();
  const Eigen::Matrix3d &u = svd.matrixU(), &v = svd.matrixV();
  if (!(size[0] > kFlat * extent)) return Eigen::Matrix3d::Identity();
  if (size[1] <= kFlat * size[0])
    return Eigen::Quaterniond::FromTwoVectors(v.col(0), u.col(0)).toRotationMatrix();
  Eigen::Vector3d sign(1, 1, u.determinant() * v.determinant() < 0 ? -1 : 1);
  return u * sign.asDiagonal() * v.transpose();
}

}  // namespace

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle < 1e-300) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

RigidMotion align(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  const Eigen::Vector3d from_mean = from.rowwise().mean(), to_mean = to.rowwise().mean();
  const Eigen::Matrix3Xd a = from.colwise() - from_mean, b = to.colwise() - to_mean;
  RigidMotion motion;
  // A machine at rest: the differences of its points are rounding of their coordinates.
  const double extent = std::max(from.squaredNorm(), to.squaredNorm());
  motion.rotation = rotation_of(b * a.transpose(), extent);
  motion.translation = to_mean - motion.rotation * from_mean;
  return motion;
}

bool fixes_motion(const Eigen::Matrix3Xd& points) {
  if (points.cols() < 3) return false;
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::Vector3d extent =
      Eigen::JacobiSVD<Eigen::Matrix3d>(centred * centred.transpose()).singularValues();
  constexpr double kOnOneLine = 1e-12;  // of squares, above what rounding makes of a line
  return extent[1] > kOnOneLine * extent[0];
}

Eigen::Matrix3Xd aligned_error(const RigidMotion& motion, const Eigen::Matrix3Xd& from,
                               const Eigen::Matrix3Xd& to) {
  return ((motion.rotation * from).colwise() + motion.translation) - to;
}

}  // namespace vernier::maths
