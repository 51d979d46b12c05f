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

struct StepLimit {
  std::int64_t step;     // AxisLimits::step
  int missing;           // missing readings before, a tick each
  std::int32_t elapsed;  // of the reading, in 1/256 of a tick
  std::int64_t most;     // largest travel that is no jump
};

// A tick that is late by more than an eighth may bring one reading more: then the axis may have moved one
// step further.
TEST(AxisMonitor, TravelAtTheLimitIsNoJumpAndOneCountMoreIs) {
  constexpr StepLimit kCases[] = {
      {2'000'000, 0, 256, 2'000'000},
      {2'000'000, 0, 288, 2'000'000},
      {2'000'000, 0, 289, 4'257'812},
      {2'000'000, 1, 100, 4'000'000},
      {2'000'000, 1, 225, 4'000'000},
      {2'000'000, 1, 256, 4'000'000},
      {2'000'000, 1, 288, 4'250'000},
      {2'000'000, 1, 289, 6'257'812},
      {2'000'000, 2, 288, 6'250'000},
      {2'000'000, 2, 289, 8'257'812},
      {INT64_MAX, 0, 512, std::int64_t{3} << 42},
      {std::int64_t{1} << 42, 0, 512, std::int64_t{3} << 42},
      {(std::int64_t{1} << 42) - 256, 0, 512, (std::int64_t{3} << 42) - 768},
      {std::int64_t{1} << 30, 0, kMostElapsed.count, std::int64_t{1} << 42},
  };
  for (const StepLimit& wanted : kCases)
    for (const int sense : {1, -1})
      for (const int more : {0, 1}) {
        AxisLimits limits;
        limits.step = wanted.step;
        Bench bench(true, limits);
        bench.take(0);
        for (int i = 0; i < wanted.missing; ++i) bench.miss();
        AxisReading reading;
        reading.position = AxisPosition(sense * (wanted.most + more));
        EXPECT_EQ(bench.monitor.take(true, reading, *bench.health, TicksQ8{wanted.elapsed}),
                  more == 0 ? Fault::kNone : Fault::kPositionJump)
            << wanted.step << " " << wanted.missing << " " << wanted.elapsed << " " << sense;
      }
}

// The smoothed speed takes a sixteenth of the new one, the acceleration a sixteenth of the change. The travel
// in a tick, and the change of the speed, count up to 2^30.
TEST(AxisMonitor, SpeedAndAccelerationOfOneTickAreLimited) {
  constexpr std::int64_t kMost = std::int64_t{1} << 30;
  struct {
    std::int64_t travel, speed, acceleration;
  } const cases[] = {{16, 1000, 1000 * 1000 / 16},
                     {1 << 24, 1'048'576'000, 65'536'000'000},
                     {kMost - 16, kMost / 16 * 1000 - 1000, kMost / 16 * 1000},
                     {kMost, kMost / 16 * 1000, kMost / 16 * 1000},
                     {kMost + 16, kMost / 16 * 1000, kMost / 16 * 1000},
                     {4 * kMost, kMost / 16 * 1000, kMost / 16 * 1000}};
  for (const auto& wanted : cases)
    for (const int sense : {1, -1}) {
      AxisLimits limits;
      limits.step = 8 * kMost;
      Bench bench(false, limits);
      bench.take(0);
      EXPECT_EQ(bench.take(sense * wanted.travel), Fault::kNone);
      EXPECT_EQ(bench.monitor.state().velocity, AxisSpeed(sense * wanted.speed)) << wanted.travel;
      EXPECT_EQ(bench.monitor.state().acceleration.count, sense * wanted.acceleration) << wanted.travel;
    }
}

TEST(AxisMonitor, SenseTurnsOneCountBeyondItsTravel) {
  for (const int sense : {1, -1}) {
    Bench bench(false);
    bench.take(0);
    bench.take(sense * 10'000);
    EXPECT_EQ(bench.monitor.state().sense, sense);
    bench.take(sense * 9'000);
    EXPECT_EQ(bench.monitor.state().sense, sense) << "exactly the limit";
    bench.take(sense * 8'999);
    EXPECT_EQ(bench.monitor.state().sense, -sense);
    EXPECT_EQ(bench.monitor.state().since, AxisTravel(1001));
    bench.take(sense * 8'998);
    EXPECT_EQ(bench.monitor.state().since, AxisTravel(1002));
  }
}

// The sum of the speeds is compared with the limit; a speed counts up to 2^40.
TEST(AxisMonitor, IndicatedTravelAtTheLimitIsNotFrozenAndOneCountMoreIs) {
  struct {
    std::int64_t travel, speed;  // AxisLimits::frozen_travel; speed of one reading
    bool frozen;
  } const cases[] = {{200'000, 200'000'000, false},
                     {200'000, 200'000'001, true},
                     {1'099'511'628, INT64_MAX, false},
                     {1'099'511'627, INT64_MAX, true},
                     {1'099'511'627, 1'099'511'627'000, false},
                     {1'099'511'627, 1'099'511'627'001, true}};
  for (const auto& wanted : cases)
    for (const int sense : {1, -1}) {
      AxisLimits limits;
      limits.frozen_travel = wanted.travel;
      Bench bench(true, limits);
      EXPECT_EQ(bench.take(0, sense * wanted.speed), wanted.frozen ? Fault::kPositionFrozen : Fault::kNone)
          << wanted.travel << " " << wanted.speed;
    }
}

}  // namespace
}  // namespace vernier::axis_monitor_test
