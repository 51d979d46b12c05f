// SPDX-License-Identifier: GPL-3.0-or-later
#include "hal/support/rounded_ratio.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>

#include "hal/support/analogue_scale.h"

namespace vernier {
namespace {

// The second way: 128 bits and a division.
std::int64_t divided(std::int64_t value, std::int64_t numerator, std::int64_t denominator) {
  const std::int64_t most = RoundedRatio::kMost;
  const __int128 held = std::clamp(value, -most, most);
  const __int128 product = (held < 0 ? -held : held) * numerator;
  const __int128 quotient =
      std::min<__int128>((2 * product + denominator) / (2 * __int128{denominator}), most);
  return static_cast<std::int64_t>(held < 0 ? -quotient : quotient);
}

TEST(RoundedRatio, IsTheNearestHalvesAwayFromZero) {
  EXPECT_EQ(RoundedRatio(1, 2).of(1), 1);
  EXPECT_EQ(RoundedRatio(1, 2).of(-1), -1);
  EXPECT_EQ(RoundedRatio(1, 2).of(3), 2);
  EXPECT_EQ(RoundedRatio(1, 3).of(1), 0);
  EXPECT_EQ(RoundedRatio(2, 3).of(1), 1);
  EXPECT_EQ(RoundedRatio(1, 1).of(INT64_MIN), -RoundedRatio::kMost);
  EXPECT_EQ(RoundedRatio(RoundedRatio::kMost, 1).of(2), RoundedRatio::kMost);
  EXPECT_EQ(RoundedRatio(1, RoundedRatio::kMost).of(RoundedRatio::kMost), 1);
}

TEST(RoundedRatio, AgreesWithADivisionEverywhere) {
  constexpr unsigned kSeed = 77;
  std::printf("seed %u\n", kSeed);
  std::mt19937_64 random(kSeed);
  const auto any = [&](int bits) {
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(random() >> (64 - bits)));
  };
  for (int i = 0; i < 1'000'000; ++i) {
    const std::int64_t numerator = any(1 + static_cast<int>(random() % 50));
    const std::int64_t denominator = any(1 + static_cast<int>(random() % 50));
    std::int64_t value = any(1 + static_cast<int>(random() % 62)) * (random() % 2 == 0 ? 1 : -1);
    // Half of them beside a half.
    if (i % 2 == 0 && numerator < denominator)
      value = static_cast<std::int64_t>(
          (__int128{2 * any(20) + 1} * denominator / (2 * __int128{numerator})) % RoundedRatio::kMost);
    ASSERT_EQ(RoundedRatio(numerator, denominator).of(value), divided(value, numerator, denominator))
        << value << " * " << numerator << " / " << denominator;
  }
}

TEST(AnalogueScale, ConverterGivesItsCodesAndTheCodesTheirCorrections) {
  const AnalogueScale scale{.span = 250'000, .codes = 65'535, .zero = 32'767, .low = 0, .high = 65'535};
  const AnalogueConverter converter(scale);
  for (std::int64_t code = 0; code <= 65'535; ++code)
    ASSERT_EQ(converter.code_for(scale.correction_of(code)), code);
  EXPECT_EQ(converter.code_for(AxisTravel(INT64_MAX)), 65'535);
  EXPECT_EQ(converter.code_for(AxisTravel(INT64_MIN)), 0);
}

}  // namespace
}  // namespace vernier
