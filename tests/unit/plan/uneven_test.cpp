// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/uneven.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace vernier::uneven_test {

using namespace vernier::plan;
namespace {

/// How alike two waves look at the positions that differ by `frequency` periods per mm: 1 where they are the
/// same at all of them.
double likeness(const std::vector<double>& positions, double frequency) {
  std::complex<double> sum = 0;
  for (const double q : positions) sum += std::polar(1.0, 2 * std::numbers::pi * frequency * q);
  return std::abs(sum) / static_cast<double>(positions.size());
}

TEST(UnevenPositions, TellAllWavesOfEvenTargetsApart) {
  constexpr double kLength_mm = 900;
  std::vector<double> targets;
  for (int i = 0; i < 13; ++i) targets.push_back(75.0 * i);
  EXPECT_NEAR(likeness(targets, 1 / 75.0), 1, 1e-9);

  std::vector<double> all = uneven_positions(0, kLength_mm, targets, 12);

  ASSERT_EQ(all.size(), 12U);
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  EXPECT_GE(all.front(), 0);
  EXPECT_LE(all.back(), kLength_mm);
  all.insert(all.end(), targets.begin(), targets.end());
  for (double waves = 3; waves < 1000; waves += 0.25)
    EXPECT_LT(likeness(all, waves / kLength_mm), 0.9) << waves;
}

}  // namespace
}  // namespace vernier::uneven_test
