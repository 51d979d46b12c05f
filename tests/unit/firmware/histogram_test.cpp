// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/core/cycle/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

namespace vernier::histogram_test {
namespace {

TEST(Histogram, EveryValueLiesWithinItsBin) {
  std::uint32_t before = 0;
  for (std::uint64_t value = 0; value < (std::uint64_t{1} << 40); value += 1 + value / 200) {
    const std::uint32_t bin = Histogram::bin_of(value);
    ASSERT_GE(bin, before);
    ASSERT_LE(value, Histogram::upper_edge(bin));
    if (bin > 0) {
      ASSERT_GT(value, Histogram::upper_edge(bin - 1)) << value;
    }
    ASSERT_LE(Histogram::upper_edge(bin) - value, value / 64 + 1) << "bins are 1/64 wide";
    before = bin;
  }
}

TEST(Histogram, PercentilesAreThoseOfTheSortedValues) {
  constexpr std::uint64_t kSeed = 11;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  std::lognormal_distribution<double> late(9, 1);
  const auto histogram = std::make_unique<Histogram>();
  std::vector<std::int64_t> values;
  for (int i = 0; i < 20000; ++i) {
    values.push_back(static_cast<std::int64_t>(late(random)));
    histogram->add(values.back());
  }
  std::sort(values.begin(), values.end());
  for (const std::uint64_t share : {500000u, 900000u, 990000u, 999000u}) {
    const auto exact = static_cast<double>(values[share * values.size() / 1000000 - 1]);
    EXPECT_NEAR(static_cast<double>(histogram->percentile_ns(share)), exact, exact / 64 + 1);
  }
  EXPECT_EQ(histogram->max_ns(), values.back());
  EXPECT_EQ(histogram->percentile_ns(1000000), values.back());
}

TEST(Histogram, ExtremesAreCountedAndNothingOverflows) {
  const auto histogram = std::make_unique<Histogram>();
  EXPECT_EQ(histogram->percentile_ns(990000), 0);
  histogram->add(INT64_MIN);
  histogram->add(INT64_MAX);
  EXPECT_EQ(histogram->count(), 2u);
  EXPECT_EQ(histogram->max_ns(), INT64_MAX);
  EXPECT_EQ(histogram->percentile_ns(500000), 0);
}

}  // namespace
}  // namespace vernier::histogram_test
