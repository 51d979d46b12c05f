// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/budget.h"
#include "tools/evaluate/limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tools/text/error.h"

namespace vernier::budget_test {

using namespace vernier::evaluate;
using namespace vernier::text;
namespace {

PositioningBudget shop() {
  PositioningBudget budget;
  for (const char* part : {"device=0.8", "misalignment=1", "thermometer=1", "expansion=11.5",
                           "expansion-range=2", "away=3", "drift=1.5"})
    add_to_budget(budget, part);
  return budget;
}

TEST(Budget, PartsAreWhatTheirPhysicsSays) {
  const auto parts = budget_parts(shop(), 1200);
  ASSERT_EQ(parts.size(), 5u);
  EXPECT_NEAR(parts[0].expanded_um, 0.96, 1e-12);
  EXPECT_NEAR(parts[1].expanded_um, 0.6 / std::sqrt(3), 1e-9);  // 1 mm/m: a cosine error of 0.5 um/m
  EXPECT_NEAR(parts[2].expanded_um, 11.5 * 1.2 / std::sqrt(3), 1e-9);
  EXPECT_NEAR(parts[3].expanded_um, 2 * 1.2 * 3 / std::sqrt(3), 1e-9);
  EXPECT_NEAR(parts[4].expanded_um, 1.5 / std::sqrt(3), 1e-9);
}

TEST(Budget, HoldsTheTruthAsOftenAsItSays) {
  // Second derivation: draw the causes, look how far E of a perfect axis of 1.2 m comes out, ends read once.
  std::mt19937_64 random(230);
  std::uniform_real_distribution<double> within(-0.5, 0.5);
  std::normal_distribution<double> normal;
  const PositioningBudget budget = shop();
  const double claimed = budget_uncertainty(budget, 1200, 5).at("E") * 1000;
  constexpr int kDraws = 20000;
  int held = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double scale = 0.5 * budget.device_um_m * normal(random) +
                         budget.expansion_um_mK * budget.thermometer_K * within(random) +
                         budget.expansion_range * budget.away_from_20_K * within(random);
    held += std::abs(1.2 * scale + budget.drift_um * within(random)) <= claimed ? 1 : 0;
  }
  // U = 2 u of a sum that a rectangle leads covers a little more than 95 %.
  EXPECT_GT(held, 0.95 * kDraws);
  EXPECT_LT(held, 0.995 * kDraws);
}

TEST(Budget, WhatIsProportionalToTheWayIsNoReversal) {
  const auto u = budget_uncertainty(shop(), 1200, 5);
  EXPECT_NEAR(u.at("B"), 1.5e-3 / std::sqrt(3) * std::sqrt(0.4), 1e-12);
  EXPECT_NEAR(u.at("R"), 3e-3 / std::sqrt(3), 1e-12);
  EXPECT_LT(u.at("B"), u.at("A"));
}

TEST(Budget, RefusesWhatItDoesNotKnow) {
  PositioningBudget budget;
  for (const char* words : {"device", "device=", "device=-1", "laser=1", "=1"})
    EXPECT_THROW(add_to_budget(budget, words), InputError) << words;
  EXPECT_FALSE(budget.given);
}

TEST(Limits, AreInTheUnitOfWhatTheyLimit) {
  const std::vector<std::string> names = {"A", "R"};
  EXPECT_DOUBLE_EQ(limit_of("A=10um", "--tolerance", names).second, 0.01);
  EXPECT_DOUBLE_EQ(limit_of("A=36arcsec", "--tolerance", names, "deg").second, 0.01);
  EXPECT_THROW(limit_of("A=1um", "--tolerance", names, "deg"), text::InputError)
      << "no length limits an angle";
  EXPECT_THROW(limit_of("A=1deg", "--tolerance", names), text::InputError);
  EXPECT_THROW(limit_of("B=1um", "--tolerance", names), text::InputError);
}

}  // namespace
}  // namespace vernier::budget_test
