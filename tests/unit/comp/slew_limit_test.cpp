// SPDX-License-Identifier: GPL-3.0-or-later
#include "comp/slew_limit.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

namespace vernier::slew_limit_test {
namespace {

TEST(SlewLimit, NeverMovesFasterUnderHostileTargets) {
  constexpr unsigned kSeed = 8;
  std::mt19937_64 random(kSeed);
  for (int round = 0; round < 100; ++round) {
    const auto step = static_cast<std::int32_t>(random() & 0x7fffffff);
    SlewLimit slew;
    std::int64_t before = 0;
    for (int tick = 0; tick < 2000; ++tick) {
      const std::uint64_t kind = random() % 4;
      const std::int32_t target = kind == 0   ? INT32_MIN
                                  : kind == 1 ? INT32_MAX
                                              : static_cast<std::int32_t>(random());
      const std::int64_t now = slew.approach(target, step);
      ASSERT_LE(std::llabs(now - before), step) << "seed " << kSeed;
      ASSERT_EQ(slew.limiting(), now != target);
      before = now;
    }
  }
}

TEST(SlewLimit, ReachesATargetInTheFewestTicks) {
  SlewLimit slew;
  EXPECT_EQ(slew.approach(25, 10), 10);
  EXPECT_EQ(slew.approach(25, 10), 20);
  EXPECT_TRUE(slew.limiting());
  EXPECT_EQ(slew.approach(25, 10), 25);
  EXPECT_FALSE(slew.limiting());
  EXPECT_EQ(slew.approach(-25, 0), 25);
}

}  // namespace
}  // namespace vernier::slew_limit_test
