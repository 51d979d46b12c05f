// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vernier::joints_test {
namespace {

constexpr double kPeriod = 0.001;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Pins of one joint, X, without HAL.
struct Bench {
  Bench() {
    JointPins& joint = pins.joint[0];
    joint = {&cmd_in, &cmd_out, &fb_in, &fb_out,   &correction, &pos_in,
             &low,    &high,    &homed, &at_limit, &saturated};
    pins.current_vel = &feed;
  }
  hal_float_t cmd_in = 0, cmd_out = 0, fb_in = kNaN, fb_out = 0, correction = 0, pos_in = kNaN;
  hal_float_t low = -1e99, high = 1e99, feed = 0;
  hal_bit_t homed = true, at_limit = false, saturated = false;
  Pins pins{};
  Joints joints{pins, Wiring{{{"X"}}, {}}};

  AxisReading tick(double commanded, std::int64_t counts = 0) {
    cmd_in = commanded;
    joints.read(kPeriod);
    AxisReading reading;
    joints.read_axis(0, reading);
    joints.write_correction(0, AxisTravel(counts));
    joints.write();
    return reading;
  }
};

TEST(Joints, GivePositionSpeedAndAccelerationOfTheSameTick) {
  Bench bench;
  bench.tick(10);
  bench.tick(10.05);
  const AxisReading reading = bench.tick(10.15);
  EXPECT_EQ(reading.position, AxisPosition(10'150'000));
  EXPECT_NEAR(static_cast<double>(reading.velocity.count), 100e6, 1) << "mm/s in nm; a rounding";
  EXPECT_NEAR(static_cast<double>(reading.acceleration.count), 50e3 * 1e6, 1e3)
      << "double's last digits over 1e-6 s^2";
  EXPECT_EQ(reading.sense, 1);
}

TEST(Joints, SenseTurnsWithTheFirstCountBackAndNotWithRounding) {
  Bench bench;
  bench.tick(10);
  bench.tick(11);
  EXPECT_EQ(bench.tick(11 - 1e-12).sense, 1) << "inverse kinematics rounds";
  EXPECT_EQ(bench.tick(11 - 0.9e-6).sense, 1);
  const AxisReading turned = bench.tick(11 - 3e-6);
  EXPECT_EQ(turned.sense, -1);
  EXPECT_EQ(turned.since, AxisTravel(3));
  EXPECT_EQ(bench.tick(10.5).since, AxisTravel(500'000));
}

TEST(Joints, CorrectionIsAddedToTheCommandAndTakenOffAnEncoderOfTheTickBefore) {
  Bench bench;
  bench.fb_in = 0;
  bench.tick(100, 20'000);
  EXPECT_DOUBLE_EQ(bench.cmd_out, 100.02);
  bench.fb_in = bench.cmd_out;  // read with the next tick, while the command goes on
  bench.tick(100.1, 21'000);
  EXPECT_NEAR(bench.fb_out, 100, 1e-12) << "a double's last digit";
  EXPECT_DOUBLE_EQ(bench.correction, 0.021);
}

TEST(Joints, FeedbackThatIsTheCommandItselfIsOfTheSameTick) {
  Bench bench;
  bench.pins.joint[0].fb_in = &bench.cmd_out;  // one signal
  bench.tick(100, 20'000);
  bench.tick(100.1, 23'000);
  EXPECT_EQ(bench.fb_out, 100.1);
}

TEST(Joints, MayCountInInches) {
  Bench bench;
  Joints joints(bench.pins, Wiring{{{"X"}}, {}}, 25.4);
  bench.cmd_in = 2;
  bench.feed = 1;
  joints.read(kPeriod);
  AxisReading reading;
  PathReading path;
  joints.read_axis(0, reading);
  joints.read_path(path);
  EXPECT_EQ(reading.position, AxisPosition(50'800'000));
  EXPECT_EQ(path.feed, FeedNmPerMin(1'524'000'000));
  joints.write_correction(0, AxisTravel(25'400));
  joints.write();
  EXPECT_NEAR(bench.cmd_out, 2.001, 1e-12) << "a double's last digit";
}

TEST(Joints, WithoutFeedbackTheCommandStandsForIt) {
  Bench bench;
  bench.tick(7, 500);
  EXPECT_EQ(bench.fb_out, 7);
}

TEST(Joints, HomingIsNoMotion) {
  Bench bench;
  bench.pos_in = 50;
  bench.tick(50);
  bench.homed = false;
  bench.pos_in = 60;
  AxisReading reading = bench.tick(60);
  EXPECT_EQ(reading.position, AxisPosition(50'000'000)) << "it counts from nowhere";
  EXPECT_EQ(reading.velocity, AxisSpeed(0));
  EXPECT_FALSE(bench.joints.all_homed());
  bench.homed = true;
  bench.pos_in = -5;
  reading = bench.tick(60);
  EXPECT_TRUE(reading.restarted);
  EXPECT_EQ(reading.position, AxisPosition(-5'000'000));
  EXPECT_EQ(reading.velocity, AxisSpeed(0));
  bench.pos_in = -4.9;
  EXPECT_FALSE(bench.tick(60.1).restarted);
}

TEST(Joints, CommandThatIsNoNumberIsNoReading) {
  Bench bench;
  bench.tick(1);
  bench.cmd_in = kNaN;
  bench.joints.read(kPeriod);
  AxisReading reading;
  EXPECT_EQ(bench.joints.read_axis(0, reading), HalFault::kNoReading);
}

TEST(Joints, DriveNeverPassesALimitAndComesToItWithoutAStep) {
  // GIVEN a correction of 20 um outward and a joint that runs into its limit at 100 mm/s, and out again
  Bench bench;
  bench.high = 50;
  for (int k = 0; k < 300; ++k) bench.tick(40, 20'000);
  double before = bench.correction, worst = 0;
  bool told = false;
  for (int k = 0; k <= 200; ++k) {
    const double commanded = 40 + (k <= 100 ? k : 200 - k) * 0.1;
    bench.tick(commanded, 20'000);
    // THEN the drive stays within it, and its correction changes by no more than the way over 128 and a count
    EXPECT_LE(bench.cmd_out, 50 + 1e-9);
    worst = std::max(worst, std::abs(bench.correction - before));
    before = bench.correction;
    told = told || bench.at_limit;
    EXPECT_TRUE(k != 100 || bench.cmd_out == 50.0);
  }
  EXPECT_LE(worst, 883e-6) << "0.1 mm / 128, and 0.1 um";
  EXPECT_TRUE(told);
  EXPECT_FALSE(bench.at_limit);
  EXPECT_DOUBLE_EQ(bench.correction, 0.02) << "all of it again";
}

TEST(Joints, LimitThatIsSetUnderACorrectionMakesNoStep) {
  Bench bench;
  for (int k = 0; k < 3; ++k) bench.tick(50, 20'000);
  bench.high = 50;
  double before = bench.correction;
  for (int k = 0; k < 300; ++k) {
    bench.tick(50, 20'000);
    EXPECT_LE(std::abs(bench.correction - before), 100.5e-6) << "0.1 um a tick";
    before = bench.correction;
  }
  EXPECT_EQ(bench.correction, 0.0);
}

}  // namespace
}  // namespace vernier::joints_test
