// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/robot_drift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/evaluate/robot_distance.h"
#include "tools/evaluate/robot_path.h"
#include "tools/text/error.h"

namespace vernier::robot_drift_test {

using namespace vernier::evaluate;
using namespace vernier::text;
namespace {

using Eigen::Vector3d;

PoseReading reading(const Vector3d& commanded, const Vector3d& measured, const char* run = "",
                    double time_s = 0) {
  PoseReading one;
  one.run = run;
  one.commanded_mm = commanded;
  one.measured_mm = measured;
  one.time_s = time_s;
  return one;
}

TEST(RobotDistance, AccuracyAndRepeatabilityByHand) {
  // GIVEN two poses 500 mm apart along (0.6, 0.8, 0), found 500.1, 500.2 and 500.3 mm apart
  const Vector3d first(0, 0, 50), second(300, 400, 50), along(0.6, 0.8, 0);
  std::vector<PoseReading> readings;
  for (const double longer : {0.1, 0.2, 0.3}) {
    readings.push_back(reading(first, first + Vector3d(7, -3, 1)));
    readings.push_back(reading(second, second + Vector3d(7, -3, 1) + longer * along));
    readings.back().u_mm = 0.003;
  }
  const auto distances = evaluate_distances(readings);
  // THEN AD = 0.2, S = 0.1 and RD = 0.3, along x 0.6 and along y 0.8 of each
  ASSERT_EQ(distances.size(), 1u);
  const DistanceResult& one = distances[0];
  EXPECT_EQ(one.count, 3u);
  EXPECT_NEAR(one.commanded_mm, 500, 1e-12);
  EXPECT_NEAR(one.accuracy_mm, 0.2, 1e-10);
  EXPECT_NEAR(one.repeatability_mm, 0.3, 1e-10);
  EXPECT_NEAR((one.accuracy_xyz_mm - Vector3d(0.12, 0.16, 0)).norm(), 0, 1e-10);
  EXPECT_NEAR((one.repeatability_xyz_mm - Vector3d(0.18, 0.24, 0)).norm(), 0, 1e-10);
  // AND its uncertainty is that of the mean of three, and twice the instrument
  EXPECT_NEAR(one.accuracy_std_mm, std::sqrt(0.01 / 3 + 2 * 0.003 * 0.003), 1e-10);
  // Tables of chi square, two degrees: 7.3778 and 0.050636.
  EXPECT_NEAR(one.low_mm, 0.3 * std::sqrt(2 / 7.3778), 1e-5);
  EXPECT_NEAR(one.high_mm, 0.3 * std::sqrt(2 / 0.050636), 1e-4);
}

TEST(RobotDistance, BackwardsIsTheSameAndTooShortIsNegative) {
  const Vector3d first(10, 0, 0), second(-90, 0, 0);
  std::vector<PoseReading> readings;
  for (int j = 0; j < 2; ++j) {
    readings.push_back(reading(first, first));
    readings.push_back(reading(second, second + Vector3d(0.5, 0, 0)));
  }
  const DistanceResult one = evaluate_distances(readings).front();
  EXPECT_NEAR(one.accuracy_mm, -0.5, 1e-12);
  EXPECT_NEAR(one.accuracy_xyz_mm[0], -0.5, 1e-12);
  EXPECT_NEAR(one.repeatability_mm, 0, 1e-12);
}

TEST(RobotDistance, ThreePosesAreTwoDistancesAndPairsMustBeWhole) {
  const Vector3d at[] = {{0, 0, 0}, {100, 0, 0}, {100, 200, 0}};
  std::vector<PoseReading> readings;
  for (int j = 0; j < 2; ++j)
    for (const Vector3d& one : at) readings.push_back(reading(one, one));
  const auto distances = evaluate_distances(readings);
  ASSERT_EQ(distances.size(), 2u);
  EXPECT_NEAR(distances[1].commanded_mm, 200, 1e-12);
  readings.pop_back();
  EXPECT_THROW(evaluate_distances(readings), InputError);
  EXPECT_THROW(evaluate_distances({readings[0], readings[0]}), InputError);
}

/// Two readings on either side of a place.
void add(std::vector<PoseReading>& readings, const Vector3d& middle, const Vector3d& off, const char* run,
         double time_s) {
  readings.push_back(reading(Vector3d::Zero(), middle + off, run, time_s));
  readings.push_back(reading(Vector3d::Zero(), middle - off, run, time_s + 10));
}

TEST(RobotDrift, ChangesAgainstTheFirstBlockByHand) {
  // GIVEN a pose that is 0.1 mm off along x, later 0.1 mm off along y and scattered twice as much, then 0.4
  // mm off along x
  std::vector<PoseReading> readings;
  add(readings, {0.1, 0, 0}, {0, 0.01, 0}, "cold", 50);
  add(readings, {0, 0.1, 0}, {0.02, 0, 0}, "an hour", 3650);
  add(readings, {0.4, 0, 0}, {0, 0.01, 0}, "warm", 7250);
  const auto drifts = evaluate_drift(readings);
  ASSERT_EQ(drifts.size(), 1u);
  const DriftResult& drift = drifts[0];
  ASSERT_EQ(drift.blocks.size(), 3u);
  // THEN AP did not change in the first hour though the pose moved, and RP by 0.01
  const DriftBlock &hour = drift.blocks[1], &warm = drift.blocks[2];
  EXPECT_NEAR(hour.time_s, 3600, 1e-9);
  EXPECT_NEAR(hour.accuracy_drift_mm, 0, 1e-12);
  EXPECT_NEAR(hour.shift_mm, std::sqrt(0.02), 1e-12);
  EXPECT_NEAR(hour.repeatability_drift_mm, 0.01, 1e-12);
  EXPECT_NEAR(warm.accuracy_drift_mm, 0.3, 1e-12);
  EXPECT_NEAR(warm.repeatability_drift_mm, 0, 1e-12);
  EXPECT_EQ(drift.accuracy_at, 2u);
  EXPECT_EQ(drift.repeatability_at, 1u);
  EXPECT_EQ(drift.shift_at, 2u);
  // AND readings that scatter across what they are off by leave dAP certain; in the same way as in both
  // blocks the instrument errs by nothing
  EXPECT_NEAR(warm.accuracy_drift_std_mm, 0, 1e-12);
  for (PoseReading& one : readings) one.u_mm = 1;
  EXPECT_NEAR(evaluate_drift(readings)[0].blocks[2].accuracy_drift_std_mm, 0, 1e-12);
}

TEST(RobotDrift, WantsBlocksInTheOrderOfTime) {
  std::vector<PoseReading> readings;
  add(readings, {0.1, 0, 0}, {0, 0.01, 0}, "b", 100);
  EXPECT_THROW(evaluate_drift(readings), InputError);
  add(readings, {0.1, 0, 0}, {0, 0.01, 0}, "a", 0);
  EXPECT_THROW(evaluate_drift(readings), InputError);
  for (PoseReading& one : readings) one.time_s = std::nan("");
  EXPECT_TRUE(std::isnan(evaluate_drift(readings)[0].blocks[1].time_s));
  readings.pop_back();
  EXPECT_THROW(evaluate_drift(readings), InputError);
}

TEST(RobotDrift, TimeIsReadWhereTheFileHasIt) {
  const auto read = read_pose_readings(
      "t[s],px[mm],py[mm],pz[mm],x[mm],y[mm],z[mm],run\n60,0,0,0,1,0,0,a\n,0,0,0,1,0,0,a\n", "m.csv");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_NEAR(read[0].time_s, 60, 1e-12);
  EXPECT_TRUE(std::isnan(read[1].time_s));
}

}  // namespace
}  // namespace vernier::robot_drift_test
