// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/lag.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vernier::lag_test {
namespace {

TEST(Lag, StartsOnItsFirstInput) {
  LagState state;
  start_lag(state, -123456);
  EXPECT_EQ(step_lag(state, -123456, 1 << 30, 40), -123456);
}

TEST(Lag, FollowsTheExponentialOfAStep) {
  LagState state;
  start_lag(state, 0);
  const double gain = -std::expm1(-1.0 / 500);
  const auto mantissa = static_cast<std::int32_t>(std::lround(std::ldexp(gain, 39)));
  for (int tick = 1; tick <= 5000; ++tick) {
    const std::int32_t y = step_lag(state, 1000000000, mantissa, 39);
    ASSERT_NEAR(y, 1e9 * -std::expm1(-tick / 500.0), 5) << "mantissa 2^-31 off: below 1e9 * 2^-30 * e^-1";
  }
}

TEST(Lag, HasNoDeadBandAtATimeConstantOfAnHour) {
  LagState state;
  start_lag(state, 0);
  const double gain = 1.0 / 3.6e6;
  const auto mantissa = static_cast<std::int32_t>(std::lround(std::ldexp(gain, 52)));
  std::int32_t y = 0;
  for (int tick = 0; tick < 36000000; ++tick) y = step_lag(state, 100, mantissa, 52);
  EXPECT_EQ(y, 100) << "after ten time constants the last LSB is reached";
}

TEST(Lag, StaysWithinItsInputsUnderHostileSignals) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 200; ++round) {
    LagState state;
    start_lag(state, INT32_MAX);
    const auto mantissa = static_cast<std::int32_t>(random() & 0x7fffffff);
    const unsigned shift = 31 + static_cast<unsigned>(random() % 4);
    std::int32_t low = INT32_MAX, high = INT32_MAX;
    for (int tick = 0; tick < 1000; ++tick) {
      const auto u = static_cast<std::int32_t>(random() % 3 == 0 ? std::uint64_t{0x80000000u} : random());
      low = std::min(low, u);
      high = std::max(high, u);
      const std::int32_t y = step_lag(state, u, mantissa, shift);
      ASSERT_GE(y, low);
      ASSERT_LE(y, high);
    }
  }
}

}  // namespace
}  // namespace vernier::lag_test
