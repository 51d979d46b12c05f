// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/error_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "comp/verify.h"

namespace vernier::error_table_test {
namespace {

/// The reciprocal by definition; the compiler has its own way to it.
Segment segment(std::int32_t start, std::uint32_t length) {
  Segment s{start, length, 0, 33};
  for (;; --s.shift) {
    const long double reciprocal = std::ceil(std::ldexp(1.0L, 30 + static_cast<int>(s.shift)) / length);
    if (reciprocal > 4294967295.0L) continue;
    s.reciprocal = static_cast<std::uint32_t>(reciprocal);
    return s;
  }
}

/// One linear column over any stations, searched by bisection or (where asked) by the grid.
struct Stations {
  std::vector<std::int32_t> records;
  ErrorTable table;

  Stations(const std::vector<std::int32_t>& at, const std::vector<std::int32_t>& v) {
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      const Segment s = segment(at[i], static_cast<std::uint32_t>(std::int64_t{at[i + 1]} - at[i]));
      for (const std::uint32_t word : {static_cast<std::uint32_t>(s.start), s.length, s.reciprocal, s.shift})
        records.push_back(static_cast<std::int32_t>(word));
      records.push_back(v[i]);
      records.push_back(v[i + 1] - v[i]);
    }
    table = {records.data(), static_cast<std::uint32_t>(at.size() - 1), 1, 1, 0, 0};
  }
  Stations(const Stations&) = delete;
  Stations& operator=(const Stations&) = delete;
  std::int32_t operator()(std::int32_t position) const {
    std::int32_t fixed = 0, any = 0;
    look_up<1, 1>(table, position, &fixed);
    look_up(table, position, &any);
    EXPECT_EQ(fixed, any);
    return fixed;
  }
};

TEST(ErrorTable, MeetsEveryStationExactly) {
  const std::vector<std::int32_t> at = {-2000000000, -5, -4, 1000, 77777, 2000000000};
  const std::vector<std::int32_t> values = {7, -2147483640, 0, INT32_MAX, 500000000, -500000000};
  const Stations table(at, values);
  for (std::size_t i = 0; i < at.size(); ++i) EXPECT_EQ(table(at[i]), values[i]) << "station " << i;
}

TEST(ErrorTable, HoldsEndValueBeyondFirstAndLastStation) {
  const Stations table({-100, 0, 1000}, {11, -20, 333});
  EXPECT_EQ(table(-100), 11);
  EXPECT_EQ(table(-101), 11);
  EXPECT_EQ(table(INT32_MIN), 11);
  EXPECT_EQ(table(1000), 333);
  EXPECT_EQ(table(1001), 333);
  EXPECT_EQ(table(INT32_MAX), 333);
}

TEST(ErrorTable, ChangesByOneLsbStepsAroundAStation) {
  const Stations table({0, 1000, 3000}, {0, 1000000, 0});
  EXPECT_EQ(table(999), 999000);
  EXPECT_EQ(table(1000), 1000000);
  EXPECT_EQ(table(1001), 999500);
}

TEST(ErrorTable, GivesTheSameValueFromBothSenses) {
  const Stations table({-500, 0, 40, 1000}, {10, -2000, 77, 5});
  std::vector<std::int32_t> up, down;
  for (std::int32_t x = -600; x <= 1100; ++x) up.push_back(table(x));
  for (std::int32_t x = 1100; x >= -600; --x) down.insert(down.begin(), table(x));
  EXPECT_EQ(up, down);
}

TEST(ErrorTable, IsWithinOneLsbOfTheStraightLine) {
  constexpr unsigned kSeed = 99;
  std::mt19937_64 random(kSeed);
  for (int round = 0; round < 300; ++round) {
    std::vector<std::int32_t> at = {static_cast<std::int32_t>(random() % 1000)}, values = {0};
    const auto count = 1 + random() % 40;
    for (std::uint64_t i = 0; i < count; ++i) {
      at.push_back(at.back() + 1 + static_cast<std::int32_t>(random() % 40000000));
      values.push_back(static_cast<std::int32_t>(random() % 200000000) - 100000000);
    }
    const Stations table(at, values);
    for (int i = 0; i < 200; ++i) {
      const auto k = static_cast<std::size_t>(random() % count);
      const auto offset = static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(at[k + 1] - at[k]));
      const double exact =
          values[k] + (static_cast<double>(values[k + 1]) - values[k]) * offset / (at[k + 1] - at[k]);
      // Half an LSB of rounding; the fraction truncates below 2^-29 of a rise of at most 2e8 counts.
      ASSERT_NEAR(table(at[k] + offset), exact, 0.5 + 2e8 / 536870912.0) << "seed " << kSeed;
    }
  }
}

TEST(ErrorTable, FindsPiecesOfEvenStationsByItsGrid) {
  constexpr unsigned kSeed = 100;
  std::mt19937_64 random(kSeed);
  int gridded = 0;
  for (int round = 0; round < 300; ++round) {
    const auto count = 1 + random() % 200;
    const double spacing = 3 + static_cast<double>(random() % 10000000) * 0.37;
    const auto first = static_cast<std::int32_t>(random() % 1000000) - 500000;
    std::vector<std::int32_t> at, values;
    for (std::uint64_t i = 0; i <= count; ++i) {
      at.push_back(first + static_cast<std::int32_t>(std::lround(static_cast<double>(i) * spacing)));
      values.push_back(static_cast<std::int32_t>(random() % 2000000) - 1000000);
    }
    Stations even(at, values);
    const int shift = std::min(63, 31 + std::ilogb(spacing));
    ErrorTable grid = even.table;
    grid.grid_multiplier = static_cast<std::uint32_t>(std::lround(std::ldexp(1.0, shift) / spacing));
    grid.grid_shift = static_cast<std::uint32_t>(shift);
    if (!grid_finds_every_piece(grid)) continue;
    ++gridded;
    for (const std::int32_t station : at)
      for (std::int32_t p = station - 3; p <= station + 3; ++p) {
        std::int32_t by_grid = 0;
        look_up<1, 1>(grid, p, &by_grid);
        ASSERT_EQ(by_grid, even(p)) << "position " << p << " seed " << kSeed;
      }
  }
  EXPECT_GT(gridded, 250);
}

TEST(ErrorTable, LooksUpAllColumnsOfAPieceAtOnce) {
  std::vector<std::int32_t> records;
  for (std::int32_t i = 0; i < 3; ++i) {
    const Segment s = segment(i * 1000, 1000);
    for (const std::uint32_t word : {static_cast<std::uint32_t>(s.start), s.length, s.reciprocal, s.shift})
      records.push_back(static_cast<std::int32_t>(word));
    for (std::int32_t c = 0; c < 12; ++c) records.push_back(1000 * c + 7 * i - 20 * (c % 4));
  }
  const ErrorTable linear{records.data(), 3, 6, 1, 0, 0}, cubic{records.data(), 3, 3, 3, 0, 0};
  for (std::int32_t p = -5; p < 3010; ++p) {
    std::int32_t fixed[6], any[6];
    look_up<1, 6>(linear, p, fixed);
    look_up(linear, p, any);
    for (int c = 0; c < 6; ++c) ASSERT_EQ(fixed[c], any[c]);
    look_up<3, 3>(cubic, p, fixed);
    look_up(cubic, p, any);
    for (int c = 0; c < 3; ++c) ASSERT_EQ(fixed[c], any[c]);
  }
}

TEST(CubicPiece, FollowsItsPolynomial) {
  const std::int32_t c[4] = {100000000, -70000000, 250000000, -90000000};
  EXPECT_EQ(cubic_between(c, 0), c[0]);
  EXPECT_EQ(cubic_between(c, kFractionOne), c[0] + c[1] + c[2] + c[3]);
  for (std::int32_t f = 0; f < kFractionOne; f += 9999991) {
    const double x = f / 1073741824.0;
    const double error = cubic_between(c, f) - (c[0] + x * (c[1] + x * (c[2] + x * c[3])));
    ASSERT_LE(error, 0.5);
    ASSERT_GE(error, -2.5);
  }
}

TEST(Wrap, ComesBackAcrossTheRolloverOneLsbBeyond) {
  const std::int32_t period = 360 << 20;
  const Wrap wrap{0, period, static_cast<std::int32_t>((std::int64_t{1} << 58) / period), 58};
  EXPECT_EQ(wrapped(wrap, 0), 0);
  EXPECT_EQ(wrapped(wrap, period - 1), period - 1);
  EXPECT_EQ(wrapped(wrap, period), 0);
  EXPECT_EQ(wrapped(wrap, period + 1), 1);
  EXPECT_EQ(wrapped(wrap, -1), period - 1);
  EXPECT_EQ(wrapped(wrap, -period), 0);
  EXPECT_EQ(wrapped(wrap, -period - 1), period - 1);
}

TEST(Wrap, AgreesWithTheModuloForAllPeriods) {
  constexpr unsigned kSeed = 31;
  std::mt19937_64 random(kSeed);
  for (int i = 0; i < 200000; ++i) {
    const std::int64_t period = 4 + static_cast<std::int64_t>(random() >> (33 + random() % 20));
    const auto first =
        static_cast<std::int32_t>(std::int64_t{static_cast<std::int32_t>(random())} % 100000000);
    if (first + period > INT32_MAX) continue;
    const auto shift = static_cast<std::uint32_t>(30 + std::ilogb(static_cast<double>(period)));
    const Wrap wrap{first, static_cast<std::int32_t>(period),
                    static_cast<std::int32_t>(((std::int64_t{1} << shift) + period / 2) / period), shift};
    const auto x = static_cast<std::int32_t>(random());
    const std::int64_t rest = ((std::int64_t{x} - first) % period + period) % period;
    ASSERT_EQ(wrapped(wrap, x), first + rest) << "period " << period << " seed " << kSeed;
  }
}

}  // namespace
}  // namespace vernier::error_table_test
