// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/thresholds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace vernier::diagnose_test {

using namespace vernier::diagnose;
namespace {

/// Names and bytes of all numbers that for_each visits.
template <class Numbers>
std::size_t visited_bytes(Numbers numbers, std::set<std::string>& names) {
  std::size_t bytes = 0;
  numbers.for_each([&](const std::string& name, auto& number) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_NE(number, 0) << name << ": half and twice of 0 tell nothing";
    bytes += sizeof(number);
  });
  return bytes;
}

TEST(Levels, AreAtMostThirtyAndEachIsVisitedOnce) {
  std::set<std::string> names;
  // All members are as wide as a double: one that for_each forgot would be missing here.
  EXPECT_EQ(visited_bytes(fit::Levels{}, names), sizeof(fit::Levels));
  EXPECT_LE(names.size(), 30U);
}

TEST(SearchExtent, EachNumberIsVisitedOnce) {
  std::set<std::string> names;
  EXPECT_EQ(visited_bytes(SearchExtent{}, names), sizeof(SearchExtent));
}

TEST(Thresholds, FollowTheLevelsInEverySubject) {
  fit::Levels levels;
  levels.strong_odds = 100;
  levels.chance = 1e-5;
  levels.negligible = 0.07;
  levels.doubtful_u = 3;
  const DiagnoseThresholds thresholds{levels};
  EXPECT_DOUBLE_EQ(thresholds.acceptance.distance, 2 * std::log(100));
  EXPECT_DOUBLE_EQ(thresholds.proof.evidence, std::log(100));
  EXPECT_DOUBLE_EQ(thresholds.fine.told_apart, 2 * std::log(100));
  EXPECT_DOUBLE_EQ(thresholds.noise.chance, 1e-5);
  EXPECT_DOUBLE_EQ(thresholds.evidence.pose_chance, 1e-5);
  EXPECT_DOUBLE_EQ(thresholds.layout.small_step, 0.07);
  EXPECT_DOUBLE_EQ(thresholds.pool.held_share, 0.07);
  EXPECT_DOUBLE_EQ(thresholds.verdict.doubtful_uncertainty, 9);
}

}  // namespace
}  // namespace vernier::diagnose_test
