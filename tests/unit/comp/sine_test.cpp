// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/sine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vernier::sine_test {
namespace {

constexpr long double kTurn = 2 * 3.14159265358979323846264338327950288L;

/// Error of both in units of 2^-30, against the long double functions (error far below 1e-3 of the unit).
double worst_error(std::uint32_t turns) {
  const long double angle = kTurn * turns / 4294967296.0L;
  const SineCosine both = sine_cosine(turns);
  EXPECT_LE(std::abs(both.sine), kSineLimit);
  EXPECT_LE(std::abs(both.cosine), kSineLimit);
  return static_cast<double>(std::max(std::abs(both.sine - std::sin(angle) * 1073741824.0L),
                                      std::abs(both.cosine - std::cos(angle) * 1073741824.0L)));
}

TEST(SineTable, HoldsTheRoundedFunctions) {
  for (std::uint32_t i = 0; i < kSineNodes; ++i) {
    const long double angle = kTurn * i / kSineNodes;
    EXPECT_EQ(kSineTable[i].sine, std::llround(std::sin(angle) * 1073741824.0L)) << i;
    EXPECT_EQ(kSineTable[i].cosine, std::llround(std::cos(angle) * 1073741824.0L)) << i;
  }
}

TEST(SineCosine, StaysWithinItsProvedBound) {
  constexpr unsigned kSeed = 30;
  std::mt19937 random(kSeed);
  double worst = 0;
  for (std::uint32_t node = 0; node < kSineNodes; ++node)
    for (const std::uint32_t edge : {0u, 1u << 22})  // nodes, and half-way where the neighbour takes over
      for (std::uint32_t off = 0; off < 400; ++off)
        worst = std::max(worst, worst_error((node << 23) + edge + off - 200));
  for (int i = 0; i < 3000000; ++i)
    worst = std::max(worst, worst_error(static_cast<std::uint32_t>(random())));
  std::printf("seed %u: error up to %.3f of 2^-30, proved %.3f\n", kSeed, worst, kSineErrorMilliLsb * 1e-3);
  EXPECT_LE(worst, kSineErrorMilliLsb * 1e-3);
  EXPECT_GT(worst, 0.5);  // it is rounded twice, after all
}

TEST(SineCosine, IsExactAtQuarterTurns) {
  EXPECT_EQ(sine_cosine(0).sine, 0);
  EXPECT_EQ(sine_cosine(0).cosine, 1 << 30);
  EXPECT_EQ(sine_cosine(1u << 30).sine, 1 << 30);
  EXPECT_EQ(sine_cosine(1u << 31).cosine, -(1 << 30));
  EXPECT_EQ(sine_cosine(3u << 30).sine, -(1 << 30));
  EXPECT_EQ(sine_cosine(3u << 30).cosine, 0);
}

TEST(SineCosine, ComesBackAfterAWholeTurn) {
  // 1 deg is 2^32/360 counts: the same angle with turns added, in a format of 20 fraction bits of a degree.
  constexpr std::int32_t kPerCount = 1527099483;  // 2^32 / 360 / 2^20 * 2^27
  const std::uint32_t one = turns_of(17 << 20, kPerCount, 27),
                      more = turns_of((17 + 3 * 360) << 20, kPerCount, 27);
  const std::uint32_t less = turns_of((17 - 2 * 360) * (1 << 20), kPerCount, 27);
  EXPECT_NEAR(static_cast<double>(static_cast<std::int32_t>(more - one)), 0, 4);
  EXPECT_NEAR(static_cast<double>(static_cast<std::int32_t>(less - one)), 0, 4);
}

}  // namespace
}  // namespace vernier::sine_test
