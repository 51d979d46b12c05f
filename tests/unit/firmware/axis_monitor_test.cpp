// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/core/cycle/axis_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace vernier::axis_monitor_test {
namespace {

struct Bench {
  explicit Bench(bool gives_motion, AxisLimits limits = {}) : monitor(limits, TimeUs(1000), gives_motion) {}
  AxisMonitor monitor;
  std::unique_ptr<Health> health = std::make_unique<Health>();

  Fault take(std::int64_t position, std::int64_t velocity = 0) {
    AxisReading reading;
    reading.position = AxisPosition(position);
    reading.velocity = AxisSpeed(velocity);
    return monitor.take(true, reading, *health);
  }
  Fault miss() { return monitor.take(false, {}, *health); }
};

TEST(AxisMonitor, ToleratesAFewMissingReadingsAndHoldsTheLast) {
  Bench bench(true);
  EXPECT_EQ(bench.take(5000), Fault::kNone);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(bench.miss(), Fault::kNone);
  EXPECT_EQ(bench.miss(), Fault::kPositionMissing);
  EXPECT_EQ(bench.monitor.state().position, AxisPosition(5000));
  EXPECT_EQ(bench.health->missing_readings, 4u);
  EXPECT_EQ(bench.take(5001), Fault::kNone);
}

TEST(AxisMonitor, AnotherZeroIsNoJumpAndNoMotion) {
  Bench bench(true);
  bench.take(0);
  AxisReading reading;
  reading.position = AxisPosition(300'000'000);
  reading.restarted = true;
  EXPECT_EQ(bench.monitor.take(true, reading, *bench.health), Fault::kNone);
  EXPECT_EQ(bench.health->jumps, 0u);
  EXPECT_EQ(bench.take(300'000'500), Fault::kNone);
}

TEST(AxisMonitor, JumpIsAFaultOnceAndTheStepLimitIsNotOne) {
  Bench bench(true);
  bench.take(0);
  EXPECT_EQ(bench.take(2'000'000), Fault::kNone);  // exactly the limit
  EXPECT_EQ(bench.take(4'000'001), Fault::kPositionJump);
  EXPECT_EQ(bench.take(4'000'001), Fault::kNone);
  EXPECT_EQ(bench.health->jumps, 1u);
  bench.miss();  // after a missing reading the axis may have moved twice as far
  EXPECT_EQ(bench.take(8'000'001), Fault::kNone);
}

// A reading after the time of exactly an eighth more is one of a tick; after that it may be two readings'.
TEST(AxisMonitor, TickThatIsLateByAnEighthHasTheLimitOfOneTick) {
  const auto fault_after = [](std::int32_t elapsed) {
    Bench bench(true);
    bench.take(0);
    AxisReading reading;
    reading.position = AxisPosition(2'000'001);
    return bench.monitor.take(true, reading, *bench.health, TicksQ8{elapsed});
  };
  EXPECT_EQ(fault_after(kOneTick.count + kOneTick.count / 8), Fault::kPositionJump);
  EXPECT_EQ(fault_after(kOneTick.count + kOneTick.count / 8 + 1), Fault::kNone);
}

// 0.2 mm/s for 5 s claim 1 mm; of them 1 s counts, which is 0.2 mm and no fault.
TEST(AxisMonitor, LongSilenceCountsAsASecondOfClaimedTravel) {
  const auto fault_at = [](std::int64_t speed) {
    Bench bench(true);
    bench.take(0, 0);
    AxisReading reading;
    reading.velocity = AxisSpeed(speed);
    return bench.monitor.take(true, reading, *bench.health, kMostElapsed);
  };
  EXPECT_EQ(fault_at(200'000), Fault::kNone);
  EXPECT_EQ(fault_at(200'001), Fault::kPositionFrozen);
}

TEST(AxisMonitor, RolloverIsNoJump) {
  AxisLimits limits;
  limits.rollover = true;
  Bench bench(true, limits);
  bench.take(kTurnCounts - 1000);
  EXPECT_EQ(bench.take(1000), Fault::kNone);
  EXPECT_EQ(bench.take(kTurnCounts + 2000), Fault::kNone);
  EXPECT_EQ(bench.take(kTurnCounts / 2), Fault::kPositionJump);
}

TEST(AxisMonitor, FrozenWhereSpeedIsClaimedAndNothingMoves) {
  Bench bench(true);
  bench.take(0, 10'000'000);  // 10 mm/s: 0.2 mm in 20 ticks
  int ticks = 0;
  while (bench.take(0, 10'000'000) == Fault::kNone) ASSERT_LT(++ticks, 100);
  EXPECT_NEAR(ticks, 20, 2);
  EXPECT_EQ(bench.health->frozen_readings, 1u);
  EXPECT_EQ(bench.take(1, 10'000'000), Fault::kNone);
}

TEST(AxisMonitor, StandingAxisWithNoisySpeedIsNotFrozen) {
  Bench bench(true);
  for (int i = 0; i < 100000; ++i)
    ASSERT_EQ(bench.take(0, i % 2 == 0 ? 3'000'000 : -3'000'000), Fault::kNone);
}

TEST(AxisMonitor, DerivesSpeedSenseAndTravelFromPositions) {
  Bench bench(false);
  std::int64_t position = 0;
  for (int i = 0; i < 400; ++i) bench.take(position += 10'000);  // 10 mm/s
  EXPECT_NEAR(static_cast<double>(bench.monitor.state().velocity.count), 1e7, 100);
  EXPECT_EQ(bench.monitor.state().sense, 1);
  EXPECT_EQ(bench.monitor.state().since, AxisTravel(INT64_MAX)) << "no reversal yet: a long way";
  for (int i = 0; i < 400; ++i) bench.take(position -= 10'000);
  EXPECT_EQ(bench.monitor.state().sense, -1);
  EXPECT_EQ(bench.monitor.state().since, AxisTravel(400 * 10'000));
}

TEST(AxisMonitor, DerivesTheAccelerationFromPositions) {
  Bench bench(false);
  for (std::int64_t i = 0; i < 400; ++i) bench.take(500 * i * i);  // 1 m/s^2
  EXPECT_NEAR(static_cast<double>(bench.monitor.state().acceleration.count), 1e9, 1e7);
}

// The board's clock and the controller's are not the same: each missing reading is a step that the axis may
// have made, though less time has passed.
TEST(AxisMonitor, EachMissingReadingIsAStepAlsoInLessTime) {
  const auto fault_after = [](std::int64_t travel) {
    Bench bench(true);
    bench.take(0);
    AxisReading reading;
    for (int i = 0; i < 3; ++i) bench.monitor.take(false, {}, *bench.health, TicksQ8{128});
    reading.position = AxisPosition(travel);
    return bench.monitor.take(true, reading, *bench.health, TicksQ8{128});
  };
  EXPECT_EQ(fault_after(4 * 2'000'000), Fault::kNone);
  EXPECT_EQ(fault_after(4 * 2'000'000 + 1), Fault::kPositionJump);
}

TEST(AxisMonitor, NoiseBelowTheDeadBandDoesNotTurnTheSense) {
  Bench bench(false);
  std::int64_t position = 0;
  for (int i = 0; i < 100; ++i) bench.take(position += 10'000);
  for (int i = 0; i < 1000; ++i) {
    bench.take(position + (i % 2 == 0 ? 400 : -400));
    ASSERT_EQ(bench.monitor.state().sense, 1);
  }
}

TEST(AxisMonitor, HostileCountsNeitherOverflowNorPass) {
  for (const bool gives_motion : {true, false}) {
    Bench bench(gives_motion);
    for (int i = 0; i < 1000; ++i) {
      bench.take(i % 2 == 0 ? INT64_MAX : INT64_MIN, i % 3 == 0 ? INT64_MIN : INT64_MAX);
      if (i % 7 == 0) bench.miss();
    }
    EXPECT_EQ(bench.take(0, INT64_MIN), Fault::kPositionJump);
  }
}

}  // namespace
}  // namespace vernier::axis_monitor_test
