// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/hand_eye.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace vernier::maths {
namespace {

RigidMotion any_motion(std::mt19937_64& random, double angle) {
  std::uniform_real_distribution<double> part(-1, 1);
  const Eigen::Vector3d axis = Eigen::Vector3d(part(random), part(random), part(random)).normalized();
  return {Eigen::AngleAxisd(angle * part(random), axis).toRotationMatrix(),
          500 * Eigen::Vector3d(part(random), part(random), part(random))};
}

void expect_equal(const RigidMotion& a, const RigidMotion& b) {
  // Rounding of products of rotations and lengths of a metre.
  EXPECT_LT((a.rotation - b.rotation).norm(), 1e-10);
  EXPECT_LT((a.translation - b.translation).norm(), 1e-7);
}

TEST(HandEye, ExactPosesGiveMountingAndEachPlace) {
  constexpr unsigned kSeed = 7;
  std::mt19937_64 random(kSeed);
  for (int trial = 0; trial < 50; ++trial) {
    const RigidMotion mounting = any_motion(random, 3.1);
    const RigidMotion places[] = {any_motion(random, 3.1), any_motion(random, 3.1)};
    std::vector<SeenPose> poses, second;
    for (std::size_t i = 0; i < 12; ++i) {
      const RigidMotion pose = any_motion(random, 1.5);
      poses.push_back({pose, places[i % 2] * pose * mounting, i % 2});
      if (i % 2 == 1) second.push_back(poses.back());
    }
    const auto found = mounting_of(poses);
    ASSERT_TRUE(found);
    expect_equal(*found, mounting);
    expect_equal(place_of(second, *found), places[1]);
  }
}

TEST(HandEye, RotationsAboutOneAxisGiveNoMounting) {
  std::vector<SeenPose> poses;
  for (int i = 0; i < 10; ++i) {
    const RigidMotion pose{Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                           Eigen::Vector3d(10.0 * i, 0, 0)};
    poses.push_back({pose, pose, 0});
  }
  EXPECT_FALSE(mounting_of(poses));
  EXPECT_FALSE(mounting_of({}));
}

}  // namespace
}  // namespace vernier::maths
