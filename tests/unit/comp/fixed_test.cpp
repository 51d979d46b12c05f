// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/fixed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "comp/quantity.h"

namespace vernier::fixed_test {
namespace {

constexpr unsigned kSeed = 4711;
constexpr int kCases = 200000;

TEST(RoundShift, RoundsToNearestWithTiesUpwards) {
  EXPECT_EQ(round_shift(5, 1), 3);
  EXPECT_EQ(round_shift(-5, 1), -2);
  EXPECT_EQ(round_shift(-6, 2), -1);
  EXPECT_EQ(round_shift(-7, 2), -2);
  EXPECT_EQ(round_shift(123456789012345, 0), 123456789012345);
  EXPECT_EQ(round_shift(std::int64_t{1} << 62, 62), 1);
}

TEST(RoundShift, IsWithinHalfAnLsbOfTheExactQuotient) {
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < kCases; ++i) {
    const std::int64_t value = static_cast<std::int64_t>(random()) >> (random() % 40 + 2);
    const unsigned shift = static_cast<unsigned>(random() % 61);
    const long double exact = std::ldexp(static_cast<long double>(value), -static_cast<int>(shift));
    ASSERT_LE(std::abs(static_cast<long double>(round_shift(value, shift)) - exact), 0.5L)
        << "seed " << kSeed;
  }
}

TEST(Saturate, KeepsWhatFitsAndReportsWhatDoesNot) {
  bool saturated = false;
  EXPECT_EQ(saturate(INT32_MAX, saturated), INT32_MAX);
  EXPECT_EQ(saturate(INT32_MIN, saturated), INT32_MIN);
  EXPECT_FALSE(saturated);
  EXPECT_EQ(saturate(std::int64_t{INT32_MAX} + 1, saturated), INT32_MAX);
  EXPECT_TRUE(saturated);
  EXPECT_EQ(saturate(0, saturated), 0);
  EXPECT_TRUE(saturated) << "a saturation is never forgotten";
  saturated = false;
  EXPECT_EQ(saturate(INT64_MIN, saturated), INT32_MIN);
  EXPECT_TRUE(saturated);
  saturated = true;
  EXPECT_EQ(saturate(5, saturated), 5);
  EXPECT_TRUE(saturated) << "never cleared";
}

TEST(Multiply, HoldsItsErrorAtTheCornersAndAtRandom) {
  EXPECT_EQ(multiply(INT32_MIN, INT32_MIN, 61), 2);
  EXPECT_EQ(multiply(INT32_MAX, INT32_MIN, 31), -INT32_MAX);
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < kCases; ++i) {
    const auto a = static_cast<std::int32_t>(random()), b = static_cast<std::int32_t>(random());
    const long double exact = static_cast<long double>(a) * b / 4294967296.0L;
    ASSERT_LE(std::abs(multiply(a, b, 32) - exact), 0.5L);
  }
}

TEST(Linear, RoundsOnceOverBothTerms) {
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < kCases; ++i) {
    const auto a = static_cast<std::int32_t>(random()), b = static_cast<std::int32_t>(random());
    const auto k = static_cast<std::int32_t>(random() % (1u << 30)),
               l = -static_cast<std::int32_t>(random() % (1u << 30));
    const long double exact =
        (static_cast<long double>(a) * k + static_cast<long double>(b) * l) / 2147483648.0L;
    if (std::abs(exact) > 2147483646.0L) continue;
    ASSERT_LE(std::abs(linear(a, k, b, l, 31) - exact), 0.5L);
    ASSERT_EQ(round_shift(product(a, k) + product(b, l), 31), linear(a, k, b, l, 31));
  }
}

TEST(Clamp, HoldsBothEdges) {
  EXPECT_EQ(clamp(5, -3, 4), 4);
  EXPECT_EQ(clamp(-5, -3, 4), -3);
  EXPECT_EQ(clamp(4, -3, 4), 4);
  EXPECT_EQ(sign_of(INT32_MIN), -1);
  EXPECT_EQ(sign_of(0), 0);
  EXPECT_EQ(sign_of(1), 1);
  EXPECT_EQ(magnitude(-INT32_MAX), INT32_MAX);
}

TEST(Quantity, ConvertsATemperatureToItsInput) {
  EXPECT_EQ(input_degC(TempMilliK(293150)).count, 20000000);
  EXPECT_EQ(input_degC(TempMilliK(0)).count, -273150000);
  static_assert(!std::is_convertible_v<std::int32_t, LengthNm>);
  static_assert(!std::is_convertible_v<LengthNm, AngleNrad>);
}

}  // namespace
}  // namespace vernier::fixed_test
