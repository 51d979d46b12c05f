// SPDX-License-Identifier: GPL-3.0-or-later
// What every Clock owes the firmware, whatever is behind it.
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "hal/linux/monotonic_clock.h"
#include "hal/sim/sim_clock.h"

namespace vernier::clock_test {
namespace {

struct Backend {
  const char* name;
  std::function<std::unique_ptr<Clock>()> make;
};

class ClockConformance : public testing::TestWithParam<Backend> {
 protected:
  std::unique_ptr<Clock> clock_ = GetParam().make();
};

TEST_P(ClockConformance, NeverRunsBackwards) {
  InstantNs before = clock_->now();
  for (int i = 0; i < 10000; ++i) {
    const InstantNs now = clock_->now();
    ASSERT_GE(now, before);
    before = now;
  }
}

TEST_P(ClockConformance, SleepsAtLeastUntilTheMoment) {
  for (int i = 0; i < 20; ++i) {
    const InstantNs due = clock_->now() + InstantNs(700'000 + 1000 * i);
    ASSERT_EQ(clock_->sleep_until(due), HalFault::kNone);
    ASSERT_GE(clock_->now(), due);
  }
}

TEST_P(ClockConformance, PastMomentIsNoFaultAndDoesNotMoveTimeBack) {
  const InstantNs now = clock_->now();
  EXPECT_EQ(clock_->sleep_until(now - InstantNs(5'000'000)), HalFault::kNone);
  EXPECT_EQ(clock_->sleep_until(InstantNs(0)), HalFault::kNone);
  EXPECT_EQ(clock_->sleep_until(InstantNs(-1)), HalFault::kNone);
  EXPECT_GE(clock_->now(), now);
}

TEST_P(ClockConformance, LateTickDoesNotShiftTheNext) {
  // 50 periods slept to absolute moments end at the fiftieth moment or later, and not a period per period
  // later: the last sleep began before its moment unless the host stole it.
  const InstantNs start = clock_->now();
  InstantNs due = start;
  int in_time = 0;
  for (int i = 0; i < 50; ++i) {
    due = due + InstantNs(1'000'000);
    in_time += clock_->now() < due ? 1 : 0;
    ASSERT_EQ(clock_->sleep_until(due), HalFault::kNone);
  }
  EXPECT_GE((clock_->now() - start).count, 50'000'000);
  EXPECT_GT(in_time, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Backends, ClockConformance,
    testing::Values(Backend{"sim", [] { return std::make_unique<SimClock>(InstantNs(1'000'000)); }},
                    Backend{"simLate",
                            [] {
                              return std::make_unique<SimClock>(InstantNs(1'000'000), InstantNs(300'000), 7);
                            }},
                    Backend{"linux", [] { return std::make_unique<MonotonicClock>(); }}),
    [](const testing::TestParamInfo<Backend>& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace vernier::clock_test
