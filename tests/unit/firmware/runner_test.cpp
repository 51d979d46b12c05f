// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/core/runner.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/firmware/rig.h"

namespace vernier::runner_test {
namespace {

/// A clock on which every sleep ends late by what the test says next.
class LateClock : public Clock {
 public:
  InstantNs now() noexcept override { return now_; }
  HalFault sleep_until(InstantNs due) noexcept override {
    now_ = std::max(now_, due) + late;
    late = {};
    return broken ? HalFault::kRefused : HalFault::kNone;
  }
  InstantNs late;
  bool broken = false;

 private:
  InstantNs now_{1'000'000};
};

struct RunnerBench {
  Rig rig;
  LateClock clock;
  Runner runner{rig.cycle(), clock, TimeUs(1000)};
  TickReport step(Command command = Command::kNone) {
    rig.plant().advance();
    return runner.step(command);
  }
  Health& health() { return rig.cycle().health(); }
};

TEST(Runner, MeasuresHowLateItWoke) {
  RunnerBench bench;
  for (int i = 0; i < 99; ++i) bench.step();
  bench.clock.late = InstantNs(70'000);
  bench.step();
  EXPECT_EQ(bench.runner.times().latency.count(), 100u);
  EXPECT_EQ(bench.runner.times().latency.max_ns(), 70'000);
  EXPECT_EQ(bench.runner.times().latency.percentile_ns(990000), 0);
  EXPECT_EQ(bench.health().overruns, 0u);
}

TEST(Runner, LateTickIsAnOverrunAndTheScheduleIsKept) {
  RunnerBench bench;
  bench.step();
  const InstantNs due = bench.runner.due();
  bench.clock.late = InstantNs(3'400'000);  // covers the next three
  bench.step();
  EXPECT_EQ(bench.health().overruns, 1u);
  EXPECT_EQ(bench.health().skipped, 3u);
  EXPECT_EQ(bench.runner.due(), due + InstantNs(4'000'000)) << "still on the same grid";
}

TEST(Runner, EndingExactlyAtTheNextTickIsNoOverrun) {
  RunnerBench bench;
  bench.clock.late = InstantNs(1'000'000);
  bench.step();
  EXPECT_EQ(bench.health().overruns, 0u);
  bench.clock.late = InstantNs(1'000'001);
  bench.step();
  EXPECT_EQ(bench.health().overruns, 1u);
}

TEST(Runner, VeryLongStopStartsANewGrid) {
  RunnerBench bench;
  bench.clock.late = InstantNs(3'600'000'000'000);
  bench.step();
  EXPECT_EQ(bench.health().overruns, 1u);
  EXPECT_EQ(bench.runner.due(), bench.clock.now() + InstantNs(1'000'000));
}

TEST(Runner, ManyOverrunsInARowAreAFault) {
  RunnerBench bench;
  while (bench.rig.cycle().mode() != Mode::kActive)
    bench.step(bench.rig.cycle().mode() == Mode::kReady && !bench.rig.asked() ? Command::kActivate
                                                                              : Command::kNone);
  for (std::uint32_t i = 0; i < kMostOverruns; ++i) {
    bench.clock.late = InstantNs(1'500'000);
    EXPECT_EQ(bench.step().latched, Fault::kNone) << i;
  }
  EXPECT_EQ(bench.step().latched, Fault::kOverrun);
}

TEST(Runner, BrokenTimerIsAFault) {
  RunnerBench bench;
  for (std::uint32_t i = 0; i < kCheckTicks; ++i) bench.step();
  bench.clock.broken = true;
  EXPECT_EQ(bench.step().latched, Fault::kClock);
}

TEST(Runner, TimeThatJumpsOrRunsBackwardsIsAClockFault) {
  for (const std::int64_t jump : {1'500'000'000, -40'000'000}) {
    RunnerBench bench;
    while (bench.rig.cycle().mode() != Mode::kReady) bench.step();
    while (bench.rig.cycle().mode() != Mode::kActive)
      bench.step(bench.rig.asked() ? Command::kNone : Command::kActivate);
    bench.clock.late = InstantNs(jump);
    bench.step();
    EXPECT_EQ(bench.rig.cycle().latched(), Fault::kClock) << jump;
    for (int i = 0; i < 1000; ++i) bench.step();
    EXPECT_EQ(bench.rig.cycle().mode(), Mode::kFaulted);
    EXPECT_EQ(bench.rig.plant().written(0), AxisTravel(0));
  }
}

}  // namespace
}  // namespace vernier::runner_test
