// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/robot_path.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "tools/text/error.h"

namespace vernier::robot_test {

using namespace vernier::evaluate;
using namespace vernier::text;
namespace {

using Eigen::Vector3d;

PoseReading reading(const Vector3d& commanded, const Vector3d& measured, const char* run = "") {
  PoseReading one;
  one.run = run;
  one.commanded_mm = commanded;
  one.measured_mm = measured;
  return one;
}

TEST(Robot, PoseByHand) {
  // GIVEN readings at (10,20,30) + (1,0,0) + one of ±(0,3,0), ±(0,0,1)
  const Vector3d at(10, 20, 30), mean(11, 20, 30);
  const auto poses =
      evaluate_poses({reading(at, mean + Vector3d(0, 3, 0)), reading(at, mean - Vector3d(0, 3, 0)),
                      reading(at, mean + Vector3d(0, 0, 1)), reading(at, mean - Vector3d(0, 0, 1))});
  // THEN the barycentre is 1 mm off, distances are 3 3 1 1: mean 2, S = sqrt(4/3), RP = 2 + 3 S
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_NEAR(poses[0].accuracy_mm, 1, 1e-12);
  EXPECT_NEAR(poses[0].deviation_mm[0], 1, 1e-12);
  EXPECT_NEAR(poses[0].mean_distance_mm, 2, 1e-12);
  EXPECT_NEAR(poses[0].distance_spread_mm, std::sqrt(4.0 / 3), 1e-12);
  EXPECT_NEAR(poses[0].repeatability_mm, 2 + 3 * std::sqrt(4.0 / 3), 1e-12);
  // The mean scatters along y and z only, and the pose is off along x.
  EXPECT_NEAR(poses[0].accuracy_std_mm, 0, 1e-12);
}

TEST(Robot, NumbersThatNumpyGives) {
  // numpy: p = c + [[.01,-.02,.03],[.04,.01,-.05],[-.03,.02,.01],[.02,-.04,.02],[-.01,.05,-.03]], c = (500,
  // -200, 300); b = p.mean(0); l = norm(p-b, axis=1); norm(b-c), l.mean() + 3*l.std(ddof=1), sqrt(e @
  // cov(p.T) @ e / 5)
  const Vector3d c(500, -200, 300);
  const double rows[][3] = {
      {.01, -.02, .03}, {.04, .01, -.05}, {-.03, .02, .01}, {.02, -.04, .02}, {-.01, .05, -.03}};
  std::vector<PoseReading> readings;
  for (const auto& r : rows) readings.push_back(reading(c, c + Vector3d(r[0], r[1], r[2])));
  const PoseResult pose = evaluate_poses(readings).front();
  EXPECT_NEAR(pose.accuracy_mm, 0.00824621125121955, 1e-12);
  EXPECT_NEAR(pose.repeatability_mm, 0.07199647630201343, 1e-10);
  EXPECT_NEAR(pose.accuracy_std_mm, 0.015541216547162536, 1e-12);
}

TEST(Robot, IntervalOfRepeatabilityHoldsTheTruthAsOftenAsItSays) {
  // GIVEN scatter of three shapes, whose true RP is the mean distance and spread of many readings
  constexpr unsigned kSeed = 20283;
  std::mt19937_64 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  std::normal_distribution<double> normal(0, 1);
  for (const Vector3d& size : {Vector3d(1, 1, 1), Vector3d(3, 1, 0.5), Vector3d(1, 0.01, 0.01)}) {
    const auto drawn = [&] {
      return Vector3d(size[0] * normal(random), size[1] * normal(random), size[2] * normal(random));
    };
    double sum = 0, squares = 0;
    constexpr int kMany = 400000;
    for (int i = 0; i < kMany; ++i) {
      const double l = drawn().norm();
      sum += l, squares += l * l;
    }
    const double mean = sum / kMany, truth = mean + 3 * std::sqrt(squares / kMany - mean * mean);
    constexpr int kTests = 400;
    int within = 0;
    for (int test = 0; test < kTests; ++test) {
      std::vector<PoseReading> readings;
      for (int i = 0; i < 30; ++i) readings.push_back(reading(Vector3d::Zero(), drawn()));
      const PoseResult pose = evaluate_poses(readings).front();
      within += pose.low_mm <= truth && truth <= pose.high_mm ? 1 : 0;
    }
    RecordProperty("held_of_400_size_" + std::to_string(size.sum()), within);
    // 0.95 within four standard deviations of 400 tests, and a little for the delta method: 0.90 to 0.99.
    EXPECT_GT(within, 0.90 * kTests) << size.transpose();
    EXPECT_LT(within, 0.99 * kTests) << size.transpose();
  }
}

TEST(Robot, RotationsAreThoseAboutTheCommandedOrientation) {
  // GIVEN an orientation of 90 deg about z, found turned by 0.1 deg about x, ± 0.02 deg about y
  std::vector<PoseReading> readings;
  for (const double y : {0.02, -0.02}) {
    PoseReading one = reading(Vector3d::Zero(), Vector3d(y, 0, 0));
    one.commanded_deg = Vector3d(0, 0, 90);
    const Vector3d error(0.1, y, 0);
    const double rad = M_PI / 180;
    const Eigen::AngleAxisd found(Eigen::AngleAxisd(error.norm() * rad, error.normalized()) *
                                  Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()));
    one.measured_deg = Vector3d(found.angle() / rad * found.axis());
    readings.push_back(one);
  }
  const PoseResult pose = evaluate_poses(readings).front();
  EXPECT_NEAR((*pose.accuracy_deg)[0], 0.1, 1e-9);
  EXPECT_NEAR((*pose.accuracy_deg)[1], 0, 1e-9);
  EXPECT_NEAR((*pose.repeatability_deg)[1], 3 * 0.02 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR((*pose.repeatability_deg)[0], 0, 1e-9);
}

TEST(Robot, PathIsJudgedAcrossItWhereverItsSamplesLie) {
  // GIVEN ten cycles along x, sampled at other places each, offset by 0.2 mm in z and by +-0.05 in y by
  // cycle, and ahead along the path by up to 3 mm, which is no deviation of the path
  std::vector<PoseReading> readings;
  const char* const runs[] = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"};
  for (int cycle = 0; cycle < 10; ++cycle)
    for (int i = 0; i <= 100; ++i) {
      const double x = i + 0.07 * cycle, y = cycle % 2 == 0 ? 0.05 : -0.05;
      readings.push_back(reading(Vector3d(x, 0, 0), Vector3d(x + 0.3 * cycle, y, 0.2), runs[cycle]));
    }
  const PathResult path = evaluate_path(readings, 20);
  ASSERT_EQ(path.stations.size(), 20u);
  // THEN AT is 0.2 mm, every distance 0.05 mm and so RT too
  EXPECT_NEAR(path.stations[path.accuracy_at].accuracy_mm, 0.2, 1e-9);
  EXPECT_NEAR(path.stations[path.repeatability_at].repeatability_mm, 0.05, 1e-9);
}

TEST(Robot, FrameOfTheInstrumentIsTakenOut) {
  std::vector<PoseReading> readings;
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(1.1, Vector3d(1, 2, 3).normalized()));
  for (const Vector3d& at :
       {Vector3d(0, 0, 0), Vector3d(500, 0, 0), Vector3d(0, 400, 0), Vector3d(100, 100, 300)})
    for (int i = 0; i < 2; ++i) readings.push_back(reading(at, turned * at + Vector3d(1000, -2000, 30)));
  align_to_commanded(readings);
  for (const PoseResult& pose : evaluate_poses(readings)) EXPECT_NEAR(pose.accuracy_mm, 0, 1e-9);
  std::vector<PoseReading> line(readings.begin(), readings.begin() + 4);
  EXPECT_THROW(align_to_commanded(line), InputError);
}

TEST(Robot, TooFewReadingsAndBadFilesAreRefused) {
  EXPECT_THROW(evaluate_poses({reading(Vector3d::Zero(), Vector3d::Zero())}), InputError);
  EXPECT_THROW(evaluate_path({reading(Vector3d::Zero(), Vector3d::Zero())}, 5), InputError);
  EXPECT_THROW(read_pose_readings("px[mm],py[mm],pz[mm],x[mm],y[mm]\n0,0,0,0,0\n", "m.csv"), InputError);
  EXPECT_THROW(read_pose_readings("px[mm],py[mm],pz[mm],x[deg],y[mm],z[mm]\n0,0,0,0,0,0\n", "m.csv"),
               InputError);
  const auto read = read_pose_readings(
      "px[mm],py[mm],pz[mm],x[um],y[mm],z[mm],run\n1,2,3,1500,2,3,a\n1,2,3,,2,3,b\n", "m.csv");
  ASSERT_EQ(read.size(), 1u);
  EXPECT_NEAR(read[0].measured_mm[0], 1.5, 1e-12);
}

}  // namespace
}  // namespace vernier::robot_test
