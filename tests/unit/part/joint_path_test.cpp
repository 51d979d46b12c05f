// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/joint_path.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "tools/part/surface/flank_path.h"
#include "tools/part/surface/s_part.h"

namespace vernier::joint_path_test {

using namespace vernier::part;
namespace {

constexpr double kPivotMm = 499.889;

std::vector<double> even(std::size_t count) {
  std::vector<double> u;
  for (std::size_t i = 0; i < count; ++i)
    u.push_back(static_cast<double>(i) / static_cast<double>(count - 1));
  return u;
}

TEST(JointPath, DirectSolutionOfTheBackSolutionIsThePoseAskedFor) {
  constexpr unsigned kSeed = 3;
  std::mt19937 generator(kSeed);
  std::uniform_real_distribution<double> mm(-300, 300), tilt(-80, 80), turn(-180, 180);
  for (int i = 0; i < 500; ++i) {
    const JointPose q{mm(generator), mm(generator), mm(generator), tilt(generator), turn(generator)};
    const ToolPose pose = tool_pose(q, kPivotMm);
    const JointPose back = joints_for(pose, kPivotMm, q.b_deg, q.c_deg);
    // Rounding of sums of 500 mm.
    EXPECT_NEAR(back.x_mm, q.x_mm, 1e-11) << "seed " << kSeed;
    EXPECT_NEAR(back.y_mm, q.y_mm, 1e-11);
    EXPECT_NEAR(back.z_mm, q.z_mm, 1e-11);
    for (const RotarySolution solution : {RotarySolution::kContinuous, RotarySolution::kPositiveB}) {
      const ToolPose again = tool_pose(back_solution({pose}, kPivotMm, solution)[0], kPivotMm);
      EXPECT_LT((again.tip - pose.tip).norm(), 1e-11);
      EXPECT_LT((again.axis - pose.axis).norm(), 1e-13);
    }
  }
}

TEST(JointPath, FollowsTipAndAxisOfTheFlank) {
  for (const RuledSurface& flank : s_part()) {
    const std::vector<double> u = even(301);
    const std::vector<JointPose> path = joint_path(flank, {}, u, kPivotMm);
    for (std::size_t i = 0; i < u.size(); ++i) {
      const FlankPose wanted = flank_pose(flank, {}, u[i]);
      const ToolPose pose = tool_pose(path[i], kPivotMm);
      EXPECT_LT((pose.tip - wanted.tip).norm(), 1e-11);
      // Below 1e-9 of lean the tool counts as vertical.
      EXPECT_LT((pose.axis - wanted.axis).norm(), 2e-9);
    }
  }
}

TEST(JointPath, ContinuousSolutionNeverJumps) {
  for (const RuledSurface& flank : s_part()) {
    const std::vector<JointPose> path = joint_path(flank, {}, even(2001), kPivotMm);
    double turn = 0, tilt = 0, low_b = 0, high_b = 0;
    for (std::size_t i = 1; i < path.size(); ++i) {
      turn = std::max(turn, std::abs(path[i].c_deg - path[i - 1].c_deg));
      tilt = std::max(tilt, std::abs(path[i].b_deg - path[i - 1].b_deg));
      low_b = std::min(low_b, path[i].b_deg);
      high_b = std::max(high_b, path[i].b_deg);
    }
    // 94 deg over 2000 steps, at most thirty times the mean near the vertical; a jump would be 180.
    EXPECT_LT(turn, 1.5);
    EXPECT_LT(tilt, 0.2);
    EXPECT_LT(low_b, -10);  // B passes the vertical
    EXPECT_GT(high_b, 10);
  }
}

TEST(JointPath, RangesAreThoseOfTheIndependentSolution) {
  // Extremes between samples differ by the sampling (0.02 mm, 0.004 deg).
  const auto range = [](const std::vector<JointPose>& path, double JointPose::*member) {
    const auto [low, high] =
        std::minmax_element(path.begin(), path.end(),
                            [&](const JointPose& a, const JointPose& b) { return a.*member < b.*member; });
    return std::pair{(*low).*member, (*high).*member};
  };
  const auto a = joint_path(s_part()[0], {}, even(2001), kPivotMm);
  EXPECT_NEAR(range(a, &JointPose::x_mm).first, -49.5941, 0.02);
  EXPECT_NEAR(range(a, &JointPose::x_mm).second, 85.7385, 0.02);
  EXPECT_NEAR(range(a, &JointPose::z_mm).first, 474.1120, 0.02);
  EXPECT_NEAR(range(a, &JointPose::b_deg).first, -14.6573, 0.004);
  EXPECT_NEAR(range(a, &JointPose::b_deg).second, 17.8373, 0.004);
  EXPECT_NEAR(range(a, &JointPose::c_deg).first, 0, 0.004);
  EXPECT_NEAR(range(a, &JointPose::c_deg).second, 93.6344, 0.004);
  const auto b = joint_path(s_part()[1], {}, even(2001), kPivotMm);
  EXPECT_NEAR(range(b, &JointPose::b_deg).first, -14.3979, 0.004);
  EXPECT_NEAR(range(b, &JointPose::b_deg).second, 13.9053, 0.004);
  EXPECT_NEAR(range(b, &JointPose::c_deg).second, 86.4196, 0.004);
}

TEST(JointPath, PositiveTiltTurnsTheTableByHalfATurnInTheMiddle) {
  const std::vector<JointPose> path =
      joint_path(s_part()[0], {}, even(2001), kPivotMm, RotarySolution::kPositiveB);
  double before = 0, after = 0;
  for (const JointPose& q : path) {
    EXPECT_GE(q.b_deg, 0);
    if (q.b_deg < 1e-3) continue;
    const bool first_half = &q - path.data() < 1000;
    (first_half ? before : after) = first_half ? q.c_deg : after == 0 ? q.c_deg : after;
  }
  EXPECT_GT(std::abs(after - before), 120);
}

TEST(JointPath, TableRunsEvenlyWhereTheToolIsVertical) {
  // The generatrix is vertical from knot 6/13 to knot 7/13 and no other constraint holds C there.
  const std::vector<JointPose> path =
      joint_path(s_part()[0], {}, {6.2 / 13, 6.4 / 13, 6.5 / 13, 6.6 / 13, 6.8 / 13}, kPivotMm);
  for (const JointPose& q : path) EXPECT_EQ(q.b_deg, 0);
  const double slope = path[1].c_deg - path[0].c_deg;
  EXPECT_NEAR(path[2].c_deg - path[1].c_deg, slope / 2, std::abs(slope) * 0.1 + 1e-9);
  EXPECT_NEAR(path[4].c_deg - path[3].c_deg, slope, std::abs(slope) * 0.1 + 1e-9);
}

}  // namespace
}  // namespace vernier::joint_path_test
