// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/hand_eye.h"

#include <Eigen/Dense>

namespace vernier::maths {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Relative motions of all rows, at most: more of them add time and no information.
constexpr std::size_t kMostMotions = 4000;
/// Cosine of half the angle of a motion. Below it, near half a turn, the sign of the axis is noise.
constexpr double kNearHalfTurn = 0.1;
/// Share of the squares of the axes across their main direction: axes within 0.6 deg are one axis.
constexpr double kOneAxis = 1e-4;

struct Motions {
  RigidMotion of_pose, of_seen;  // A and B of A X = X B
};

std::vector<Motions> relative_motions(const std::vector<SeenPose>& poses) {
  std::vector<Motions> list;
  for (std::size_t step = 1; step < poses.size() && list.size() < kMostMotions; ++step)
    for (std::size_t i = 0; i + step < poses.size(); ++i) {
      const SeenPose &a = poses[i], &b = poses[i + step];
      if (a.group != b.group) continue;
      list.push_back({inverse_of(a.pose) * b.pose, inverse_of(a.seen) * b.seen});
    }
  return list;
}

/// Returns 2 sin(angle / 2) times the axis of a rotation; nullopt near half a turn.
std::optional<Vector3d> axis_of(const Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  if (q.w() < kNearHalfTurn) return std::nullopt;
  return 2 * q.vec();
}

/// Rotation that is nearest to a matrix (orthogonal Procrustes).
Matrix3d nearest_rotation(const Matrix3d& matrix) {
  const Eigen::JacobiSVD<Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d sign(1, 1, 1);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign[2] = -1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

RigidMotion operator*(const RigidMotion& first, const RigidMotion& second) {
  return {first.rotation * second.rotation, first.rotation * second.translation + first.translation};
}

RigidMotion inverse_of(const RigidMotion& motion) {
  return {motion.rotation.transpose(), -(motion.rotation.transpose() * motion.translation)};
}

std::optional<RigidMotion> mounting_of(const std::vector<SeenPose>& poses) {
  const std::vector<Motions> motions = relative_motions(poses);
  Matrix3d together = Matrix3d::Zero(), spread = Matrix3d::Zero();
  for (const Motions& one : motions) {
    const auto a = axis_of(one.of_pose.rotation), b = axis_of(one.of_seen.rotation);
    if (!a || !b) continue;
    together += *a * b->transpose();
    spread += *b * b->transpose();
  }
  const Vector3d squares = Eigen::SelfAdjointEigenSolver<Matrix3d>(spread).eigenvalues();
  if (!(squares[1] > kOneAxis * squares[2])) return std::nullopt;
  RigidMotion mounting{nearest_rotation(together), Vector3d::Zero()};
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const Motions& one : motions) {
    const Matrix3d factor = one.of_pose.rotation - Matrix3d::Identity();
    normal += factor.transpose() * factor;
    right += factor.transpose() * (mounting.rotation * one.of_seen.translation - one.of_pose.translation);
  }
  mounting.translation = normal.ldlt().solve(right);
  return mounting;
}

RigidMotion place_of(const std::vector<SeenPose>& poses, const RigidMotion& mounting) {
  Matrix3d sum = Matrix3d::Zero();
  for (const SeenPose& one : poses) sum += one.seen.rotation * (one.pose * mounting).rotation.transpose();
  RigidMotion place{nearest_rotation(sum), Vector3d::Zero()};
  for (const SeenPose& one : poses)
    place.translation += (one.seen.translation - place.rotation * (one.pose * mounting).translation) /
                         static_cast<double>(poses.size());
  return place;
}

}  // namespace vernier::maths
