// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/motion_limit.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

namespace vernier::motion_limit_test {
namespace {

TEST(MotionLimit, ArrivesExactlyAndDoesNotOvershootAStandingTarget) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const MotionBounds bounds{1 + static_cast<std::int64_t>(random() % 5000),
                              1 + static_cast<std::int64_t>(random() % 300)};
    const auto target = static_cast<std::int64_t>(random() % 2'000'001) - 1'000'000;
    MotionLimit limit;
    std::int64_t before = 0, speed = 0;
    int ticks = 0;
    for (; ticks < 4'000'000 && limit.value() != target; ++ticks) {
      const std::int64_t now = limit.approach(target, bounds);
      ASSERT_LE(std::abs(now - before), bounds.slew);
      ASSERT_LE(std::abs(now - before - speed), bounds.acceleration);
      ASSERT_LE(std::abs(now), std::abs(target)) << "trial " << trial;
      speed = now - before;
      before = now;
    }
    ASSERT_EQ(limit.value(), target);
    ASSERT_LE(std::abs(limit.speed()), bounds.acceleration) << "it can stop in one tick";
    EXPECT_EQ(limit.approach(target, bounds), target);
  }
}

TEST(MotionLimit, IsNotSlowerThanNeeded) {
  // 1 mm at 5 nm a tick each tick and 2000 nm a tick: 400 ticks to speed, 400 to brake, the rest at speed.
  MotionLimit limit;
  int ticks = 0;
  while (limit.approach(1'000'000, {2000, 5}) != 1'000'000) ++ticks;
  EXPECT_GE(ticks, 900 - 2);
  EXPECT_LE(ticks, 920) << "the last stretch is covered at up to one acceleration below the ideal speed";
}

TEST(MotionLimit, HoldsItsBoundsForEveryTarget) {
  std::mt19937_64 random(2);
  MotionLimit limit;
  std::int64_t before = 0, speed = 0;
  const MotionBounds bounds{700, 40};
  for (int tick = 0; tick < 1'000'000; ++tick) {
    const auto target = static_cast<std::int64_t>(static_cast<std::int32_t>(random())) >> (random() % 32);
    const std::int64_t now = limit.approach(target, bounds);
    ASSERT_LE(std::abs(now - before), bounds.slew);
    ASSERT_LE(std::abs(now - before - speed), bounds.acceleration);
    speed = now - before;
    before = now;
  }
}

TEST(MotionLimit, WithoutBoundsItIsThere) {
  MotionLimit limit;
  EXPECT_EQ(limit.approach(1'900'000'000, {}), 1'900'000'000);
  EXPECT_EQ(limit.approach(-200'000'000, {}), -200'000'000);
}

TEST(MotionLimit, SlowsDownWithinItsAccelerationWhenItsSpeedIsLowered) {
  MotionLimit limit;
  for (int i = 0; i < 100; ++i) limit.approach(1'000'000'000, {1000, 50});
  ASSERT_EQ(limit.speed(), 1000);
  for (int i = 1; i <= 16; ++i) {
    limit.approach(1'000'000'000, {200, 50});
    EXPECT_EQ(limit.speed(), std::max<std::int64_t>(1000 - 50 * i, 200));
  }
}

}  // namespace
}  // namespace vernier::motion_limit_test
