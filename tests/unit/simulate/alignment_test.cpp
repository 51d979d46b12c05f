// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/alignment.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace vernier::alignment_test {

using namespace vernier::maths;
namespace {

constexpr std::uint64_t kSeed = 5;

Eigen::Matrix3Xd random_points(int count, const Eigen::Vector3d& size, std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(-1, 1);
  Eigen::Matrix3Xd points(3, count);
  for (int i = 0; i < count; ++i)
    points.col(i) = size.cwiseProduct(Eigen::Vector3d(share(random), share(random), share(random)));
  return points;
}

Eigen::Matrix3d random_rotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized()
      .toRotationMatrix();
}

// Coordinates of 600 mm in double: 1e-13 mm a coordinate; the bound leaves room for sums of them.
constexpr double kRounding_mm = 1e-9;

TEST(Align, RemovesAnyRigidMotion) {
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  const Eigen::Vector3d shapes[] = {
      {300, 200, 100}, {300, 200, 0}, {300, 0, 0}, {0, 0, 0}, {300, 1e-3, 1e-4}};
  for (const Eigen::Vector3d& shape : shapes)
    for (int i = 0; i < 50; ++i) {
      const Eigen::Matrix3Xd to = random_points(40, shape, random).colwise() + Eigen::Vector3d(500, -20, 3);
      const Eigen::Matrix3d rotation = random_rotation(random);
      const Eigen::Matrix3Xd from = (rotation * to).colwise() + Eigen::Vector3d(1, 2, 3);
      const RigidMotion motion = align(from, to);
      ASSERT_NEAR(motion.rotation.determinant(), 1, 1e-12);
      ASSERT_LT((motion.rotation * motion.rotation.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
      // A needle's roll is known from the 1e-13 part of its covariance only: 1e-3 mm times 1e-16 / 1e-13.
      const double allowed = shape[1] == 1e-3 ? 1e-6 : kRounding_mm;
      ASSERT_LT(aligned_error(motion, from, to).cwiseAbs().maxCoeff(), allowed) << shape.transpose();
    }
}

TEST(Align, OnePointIsOnlyShifted) {
  const Eigen::Matrix3Xd from = Eigen::Vector3d(1, 2, 3), to = Eigen::Vector3d(-4, 0, 9);
  const RigidMotion motion = align(from, to);
  EXPECT_EQ(motion.rotation, Eigen::Matrix3d::Identity());
  EXPECT_LT(aligned_error(motion, from, to).norm(), 1e-15);
}

TEST(Align, LineIsTurnedNoFurtherThanNeeded) {
  Eigen::Matrix3Xd to(3, 50), from(3, 50);
  const double tilt = 1e-4;
  for (int i = 0; i < 50; ++i) {
    to.col(i) = Eigen::Vector3d(10.0 * i, 0, 0);
    from.col(i) = Eigen::Vector3d(10.0 * i * std::cos(tilt), 10.0 * i * std::sin(tilt), 0);
  }
  const RigidMotion motion = align(from, to);
  EXPECT_LT(aligned_error(motion, from, to).cwiseAbs().maxCoeff(), kRounding_mm);
  EXPECT_NEAR(Eigen::AngleAxisd(motion.rotation).angle(), tilt, 1e-9);
}

TEST(Align, NeverReflects) {
  std::mt19937_64 random(kSeed);
  const Eigen::Matrix3Xd to = random_points(30, {100, 80, 60}, random);
  Eigen::Matrix3Xd from = to;
  from.row(2) *= -1;
  const RigidMotion motion = align(from, to);
  EXPECT_NEAR(motion.rotation.determinant(), 1, 1e-12);
  EXPECT_GT(aligned_error(motion, from, to).norm(), 100);
}

TEST(Align, IsTheMinimum) {
  // Any small further motion makes the sum of squares larger.
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  const Eigen::Matrix3Xd to = random_points(60, {300, 200, 5}, random);
  const Eigen::Matrix3Xd from = random_rotation(random) * to + random_points(60, {0.02, 0.02, 0.02}, random);
  const RigidMotion best = align(from, to);
  const double least = aligned_error(best, from, to).squaredNorm();
  for (int i = 0; i < 200; ++i) {
    RigidMotion other = best;
    const Eigen::Vector3d axis(normal(random), normal(random), normal(random));
    other.rotation = Eigen::AngleAxisd(1e-6, axis.normalized()) * best.rotation;
    other.translation += 1e-4 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    ASSERT_GT(aligned_error(other, from, to).squaredNorm(), least);
  }
}

TEST(Align, ScaleIsNotRemoved) {
  std::mt19937_64 random(kSeed);
  const Eigen::Matrix3Xd to = random_points(100, {300, 200, 100}, random);
  const Eigen::Matrix3Xd from = 1.0001 * to;
  const Eigen::Matrix3Xd centred = to.colwise() - Eigen::Vector3d(to.rowwise().mean());
  EXPECT_NEAR(aligned_error(align(from, to), from, to).norm(), 1e-4 * centred.norm(), 1e-9);
}

}  // namespace
}  // namespace vernier::alignment_test
