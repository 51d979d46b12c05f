// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vernier::joints_test {
namespace {

constexpr double kPeriod = 0.001;
constexpr std::int64_t kAnySlew = 1'000'000'000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Pins of one joint, X, without HAL.
struct Bench {
  Bench() {
    JointPins& joint = pins.joint[0];
    joint = {&cmd_in, &cmd_out, &fb_in, &fb_out,   &correction, &pos_in, &low,
             &high,   &fast,    &homed, &at_limit, &saturated,  &pos_in, &fb_in};
    pins.current_vel = &feed;
    joints.set_slew(0, kAnySlew);
  }
  hal_float_t cmd_in = 0, cmd_out = 0, fb_in = kNaN, fb_out = 0, correction = 0, pos_in = kNaN;
  hal_float_t low = -1e99, high = 1e99, fast = 0, feed = 0;
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
  joints.set_slew(0, kAnySlew);
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

/// A bench whose feedback and position come by signals.
struct ConnectedBench : Bench {
  ConnectedBench() {
    pins.joint[0].pos_in = &position;
    pins.joint[0].fb_in = &feedback;
    for (int k = 0; k < 3; ++k) go(1);
  }
  HalFault go(double commanded) {
    cmd_in = commanded;
    joints.read(kPeriod);
    AxisReading reading;
    const HalFault fault = joints.read_axis(0, reading);
    joints.write_correction(0, AxisTravel(500));
    joints.write();
    return fault;
  }
  hal_float_t position = 1, feedback = 1.0004;
};

/// What the cycle finds in a bench's reading.
struct Watched : ConnectedBench {
  Fault watch(double commanded, double stands) {
    position = commanded;
    feedback = stands;
    go(commanded);
    AxisReading reading;
    joints.read_axis(0, reading);
    return monitor.take(true, reading, health);
  }
  Health health;
  AxisMonitor monitor{{}, TimeUs(1000), true};
};

TEST(Joints, CommandThatIsLaidOnTheFeedbackIsNoJump) {
  // GIVEN an axis that stands at 10.0005 while its command runs on to 17, the correction in
  Watched bench;
  bench.position = 10, bench.go(10);
  for (int k = 0; k <= 700; ++k) EXPECT_EQ(bench.watch(10 + 0.01 * k, 10.0005), Fault::kNone);
  // WHEN LinuxCNC gives up: its command is what it read last
  EXPECT_EQ(bench.watch(bench.fb_out, 10.0005), Fault::kNone);
  // THEN the axis is there, without a speed, and the sense is what it was
  EXPECT_EQ(bench.monitor.state().position, AxisPosition(10'000'000));
  EXPECT_EQ(bench.monitor.state().velocity, AxisSpeed(0));
  EXPECT_EQ(bench.monitor.state().sense, 1);
  EXPECT_EQ(bench.watch(bench.fb_out, 10.0005), Fault::kNone);
}

TEST(Joints, SpeedOfAFollowingErrorIsNoSpeedOfTheJoint) {
  // GIVEN a joint that goes 10 mm/s and is laid on its feedback by 1.9 mm, no jump to the cycle
  Watched bench;
  bench.position = 10, bench.go(10);
  for (int k = 0; k <= 190; ++k) bench.watch(10 + 0.01 * k, 10.0005);
  EXPECT_EQ(bench.watch(bench.fb_out, 10.0005), Fault::kNone);
  EXPECT_EQ(bench.monitor.state().velocity, AxisSpeed(0));
  // THEN a limit at 1 mm lets what 1/128 of the way is, as before: not that of a joint of 1900 mm/s
  bench.joints.set_slew(0, 200);
  bench.high = 11;
  EXPECT_EQ(bench.joints.within_range(0, AxisTravel(20'000)), AxisTravel(1'000'000 / 128));
}

TEST(Joints, ReadingThatWasMissingMakesTheWayNoFaster) {
  ConnectedBench bench;
  bench.position = 1.01;
  bench.go(1.01);
  bench.position = kNaN;
  bench.go(1.02);
  bench.position = 1.03;
  bench.go(1.03);
  AxisReading reading;
  bench.joints.read_axis(0, reading);
  EXPECT_NEAR(static_cast<double>(reading.velocity.count), 10e6, 1) << "a rounding";
}

TEST(Joints, JumpToAnywhereElseIsOne) {
  Watched bench;
  bench.watch(10, 10);
  EXPECT_EQ(bench.watch(11.9, 10), Fault::kNone) << "2 mm a tick are 2 m/s";
  EXPECT_EQ(bench.watch(14, 11.9), Fault::kPositionJump);
  EXPECT_EQ(bench.watch(9, 14), Fault::kPositionJump);
}

TEST(Joints, CommandThatIsNoNumberIsNoReadingAndLeavesTheDriveWhereItIs) {
  for (const double none : {kNaN, std::numeric_limits<double>::infinity()}) {
    ConnectedBench bench;
    EXPECT_EQ(bench.go(none), HalFault::kNoReading) << "though the position is one";
    EXPECT_DOUBLE_EQ(bench.cmd_out, 1.0005);
    EXPECT_DOUBLE_EQ(bench.fb_out, 1.0004 - 0.0005);
    EXPECT_EQ(bench.go(1.1), HalFault::kNone);
    EXPECT_DOUBLE_EQ(bench.cmd_out, 1.1005);
  }
}

TEST(Joints, ConnectedPositionThatIsNoNumberIsNoReading) {
  ConnectedBench bench;
  bench.position = kNaN;
  EXPECT_EQ(bench.go(1), HalFault::kNoReading) << "the command does not stand for it";
  bench.pins.joint[0].pos_in = &bench.pos_in;  // unlinkp
  EXPECT_EQ(bench.go(1), HalFault::kNone);
}

TEST(Joints, ConnectedFeedbackThatIsNoNumberIsNoReadingAndNoPerfectFeedback) {
  for (const double none : {kNaN, std::numeric_limits<double>::infinity()}) {
    ConnectedBench bench;
    bench.feedback = none;
    EXPECT_EQ(bench.go(5), HalFault::kNoReading);
    EXPECT_DOUBLE_EQ(bench.fb_out, 1.0004 - 0.0005) << "where it was: LinuxCNC sees a following error";
    bench.feedback = 5.0004;
    EXPECT_EQ(bench.go(5), HalFault::kNone);
    EXPECT_DOUBLE_EQ(bench.fb_out, 5.0004 - 0.0005);
  }
}

/// A joint that runs into its limit at mm/s and out again, under a correction of so many counts outward.
struct RunToTheLimit {
  Bench bench;
  double worst = 0, beyond = 0;  // largest change of the correction, way past the limit; mm
  bool told = false;

  void go(double mm_per_s, std::int64_t counts, std::int64_t slew, double ramp_mm_per_s2 = 1e9) {
    bench.high = 50;
    bench.joints.set_slew(0, slew);
    // Far enough out that all of it is in: at least the way in which it fades.
    const double share = std::min(1.0 / 128, (static_cast<double>(slew) - 1) / (mm_per_s * 1e3));
    const double start = 50 - 1.5 * static_cast<double>(counts) * 1e-6 / share;
    double position = start, velocity = 0;
    for (int k = 0; k < 2 * counts / slew + 10; ++k) bench.tick(position, counts);
    double before = bench.correction;
    const auto step = [&] {
      bench.tick(position, counts);
      worst = std::max(worst, std::abs(bench.correction - before));
      beyond = std::max(beyond, bench.cmd_out - 50);
      before = bench.correction;
      told = told || bench.at_limit;
    };
    // Up to speed, and to a stop at the limit as a controller brakes.
    while (position < 50) {
      const double brakes = std::sqrt(2 * ramp_mm_per_s2 * (50 - position));
      velocity = std::min({mm_per_s, velocity + ramp_mm_per_s2 * kPeriod, brakes});
      position = std::min(50.0, position + std::max(velocity, 0.01) * kPeriod);
      step();
    }
    EXPECT_TRUE(bench.at_limit);
    for (int k = 0; k < 100; ++k) step();
    EXPECT_EQ(bench.cmd_out, 50.0);
    for (; position > start; position -= mm_per_s * kPeriod) step();
    for (int k = 0; k < 2 * counts / slew + 10; ++k) step();
    EXPECT_DOUBLE_EQ(bench.correction, static_cast<double>(counts) * 1e-6) << "all of it again";
    EXPECT_FALSE(bench.at_limit);
  }
};

class JointsAtALimit : public testing::TestWithParam<std::tuple<double, std::int64_t, std::int64_t>> {};

TEST_P(JointsAtALimit, KeepTheSlewLimitAndTheLimitAtTheSpeedThatTheyAreTold) {
  const auto [speed, counts, slew] = GetParam();
  for (const double ramp : {1e9, 1200.0}) {
    RunToTheLimit run;
    run.bench.fast = speed;
    run.go(speed, counts, slew, ramp);
    EXPECT_LE(run.worst, static_cast<double>(slew) * 1e-6 + 1e-12) << "a double's last digits";
    EXPECT_LE(run.beyond, 1e-9) << "a double's last digits";
    EXPECT_TRUE(run.told);
  }
}

INSTANTIATE_TEST_SUITE_P(SpeedsCorrectionsAndSlewLimits, JointsAtALimit,
                         testing::Combine(testing::Values(7.0, 120.0, 500.0),
                                          testing::Values(20'000, 300'001),
                                          testing::Values(1'000, 200, 2'500)));

TEST(Joints, FasterThanTheyWereToldKeepTheSlewLimitAndLearnTheSpeed) {
  RunToTheLimit first;
  first.go(120, 20'000, 200);
  EXPECT_LE(first.worst, 200e-6 + 1e-12) << "always";
  // The same joint once more: now it knows.
  first.worst = first.beyond = 0;
  first.go(120, 20'000, 200);
  EXPECT_LE(first.worst, 200e-6 + 1e-12);
  EXPECT_LE(first.beyond, 1e-9);
}

TEST(Joints, LimitThatIsSetUnderACorrectionMakesNoStep) {
  Bench bench;
  bench.joints.set_slew(0, 100);
  for (int k = 0; k < 300; ++k) bench.tick(50, 20'000);
  ASSERT_DOUBLE_EQ(bench.correction, 0.02);
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
