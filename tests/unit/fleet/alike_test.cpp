// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/alike.h"
#include "tools/text/wall_time.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace vernier::alike_test {

using namespace vernier::registry;
namespace {

/// A fleet's weekly readings: a hall that warms in summer, a machine (number 0) that drifts; in units of the
/// noise.
struct DrawnFleet {
  int machines = 8, weeks = 26;
  double hall = 0, own_per_day = 0, beyond_stated = 1;
  bool gaps = true;
  double wander = 0, kept = 0;  // step of each week's wandering, and what is kept of it to the next; 1: all
  double last_off = 0;          // by which the last reading of machine 1 is off

  std::vector<FleetReading> draw(std::mt19937_64& random) const {
    std::normal_distribution<double> normal(0, 1);
    std::uniform_real_distribution<double> share(0, 1);
    std::vector<FleetReading> readings;
    for (int machine = 0; machine < machines; ++machine) {
      const double level = 20 * normal(random);
      double away = 0;
      for (int week = 0; week < weeks; ++week) {
        if (wander > 0) away = kept * away + wander * normal(random);
        if (gaps && share(random) < 0.2) continue;
        const double day = 7 * week + 5 * share(random);
        const double common = hall * std::sin(2 * M_PI * day / 365);
        const double own = machine == 0 ? own_per_day * day : 0;
        readings.push_back({"m" + std::to_string(machine), "sxy", "um/m",
                            static_cast<std::int64_t>(day * text::kUsADay),
                            level + common + own + away + beyond_stated * normal(random), 1.0});
      }
      if (machine == 1) readings.back().value += last_off;
    }
    return readings;
  }
};

int count(int fleets, const DrawnFleet& drawn, const std::function<bool(const Drift&)>& is,
          std::uint64_t seed) {
  std::mt19937_64 random(seed);
  int found = 0;
  for (int i = 0; i < fleets; ++i) found += is(drifts(drawn.draw(random), {7, 0.05}).at(0)) ? 1 : 0;
  return found;
}

// Binomial of 300 at 5 %: 15, and 27 or more with a chance of 0.2 %.
TEST(Alike, QuietFleetsRaiseNoMoreAlarmsThanStated) {
  const auto any = [](const Drift& drift) { return drift.common || !drift.own.empty(); };
  EXPECT_LT(count(300, {}, any, 1), 27);
  DrawnFleet noisier;
  noisier.beyond_stated = 3;
  EXPECT_LT(count(300, noisier, any, 2), 27) << "a scatter beyond what is stated is no drift";
}

TEST(Alike, WhatWandersDriftsNoMoreThanStated) {
  const auto any = [](const Drift& drift) { return drift.common || !drift.own.empty(); };
  DrawnFleet forgets, walks;
  forgets.wander = 0.6, forgets.kept = 0.8;
  walks.wander = 0.5, walks.kept = 1;
  EXPECT_LT(count(300, forgets, any, 11), 27);
  EXPECT_LT(count(300, walks, any, 12), 27);
  walks.wander = 1.5;
  std::mt19937_64 random(13);
  const Drift told = drifts(walks.draw(random), {7, 0.05}).at(0);
  EXPECT_GT(told.wander, 0.3);
}

TEST(Alike, OneReadingIsNoDrift) {
  DrawnFleet off;
  off.last_off = 12;
  EXPECT_LE(count(
                100, off, [](const Drift& drift) { return !drift.own.empty(); }, 14),
            10);
}

TEST(Alike, ACommonCauseIsNoMachinesOwn) {
  DrawnFleet drawn;
  drawn.hall = 4;
  EXPECT_EQ(count(
                100, drawn, [](const Drift& drift) { return drift.common; }, 3),
            100);
  // Own rates are asked for at half of the 5 %.
  EXPECT_LT(count(
                300, drawn, [](const Drift& drift) { return !drift.own.empty(); }, 4),
            17);
}

TEST(Alike, AMachinesOwnDriftIsToldBesideACommonCause) {
  DrawnFleet drawn;
  drawn.hall = 4, drawn.own_per_day = 0.05;  // 9 noises in half a year
  const auto told = [&](const Drift& drift) {
    return drift.own.size() == 1 && drift.own[0].machine == "m0" &&
           std::abs(drift.own[0].per_day - 0.05) < 4 * drift.own[0].std;
  };
  EXPECT_GE(count(100, drawn, told, 5), 95);
  DrawnFleet still;
  still.own_per_day = 0.05;
  EXPECT_LE(count(
                100, still, [](const Drift& drift) { return drift.common; }, 6),
            8)
      << "one machine is no common cause";
}

TEST(Alike, ReadingsThatNeverChangeDriftNowhere) {
  std::vector<FleetReading> readings;
  for (const char* machine : {"a", "b", "c"})
    for (int week = 0; week < 6; ++week)
      readings.push_back(
          {machine, "k", "", static_cast<std::int64_t>(7 * week * text::kUsADay), 1.0 / 3e5, 1e-7});
  const Drift drift = drifts(readings, {}).at(0);
  EXPECT_TRUE(drift.judged);
  EXPECT_FALSE(drift.common);
  EXPECT_TRUE(drift.own.empty());
}

TEST(Alike, TooLittleIsNotJudged) {
  DrawnFleet drawn;
  drawn.machines = 2;
  std::mt19937_64 random(1);
  EXPECT_FALSE(drifts(drawn.draw(random), {}).at(0).judged);
  EXPECT_TRUE(drifts({}, {}).empty());
}

}  // namespace
}  // namespace vernier::alike_test
