// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/core/cycle/runner.h"

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

TEST(Runner, FollowingItsCallerItCountsCallsAndNotTheClock) {
  RunnerBench bench;
  bench.runner.follow_caller();
  bench.step();
  const InstantNs first = bench.runner.woke();
  bench.clock.late = InstantNs(70'000'000);  // no sleep takes it up
  for (int i = 0; i < 9; ++i) bench.step();
  EXPECT_EQ(bench.runner.woke(), first + InstantNs(9'000'000));
  EXPECT_EQ(bench.runner.time(), TimeUs(10'000));
  EXPECT_EQ(bench.runner.times().execution.count(), 10u);
  EXPECT_EQ(bench.health().overruns + bench.health().skipped, 0u);
}

/// A clock that goes on between two looks at it: a tick takes this time.
class BusyClock : public Clock {
 public:
  InstantNs now() noexcept override { return now_ = now_ + taken; }
  HalFault sleep_until(InstantNs) noexcept override { return HalFault::kNone; }
  InstantNs taken{1000};

 private:
  InstantNs now_;
};

TEST(Runner, TicksOfACallerThatTakeLongerThanTheirPeriodAreAFault) {
  Rig rig;
  BusyClock clock;
  Runner runner(rig.cycle(), clock, TimeUs(1000));
  runner.follow_caller();
  const auto step = [&] {
    rig.plant().advance();
    return runner.step(Command::kNone).latched;
  };
  while (rig.cycle().mode() != Mode::kReady) step();
  clock.taken = InstantNs(1'000'000);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(step(), Fault::kNone) << "exactly a period";
  EXPECT_EQ(rig.cycle().health().overruns, 0u);
  clock.taken = InstantNs(1'000'001);
  for (std::uint32_t i = 0; i < OverrunLimits{}.in_a_row; ++i) EXPECT_EQ(step(), Fault::kNone) << i;
  EXPECT_EQ(rig.cycle().health().overruns, OverrunLimits{}.in_a_row);
  EXPECT_EQ(step(), Fault::kOverrun);
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
  EXPECT_EQ(bench.health().skipped, 0u);
  EXPECT_EQ(bench.runner.due(), bench.clock.now()) << "the next tick begins now";
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
  for (std::uint32_t i = 0; i < OverrunLimits{}.in_a_row; ++i) {
    bench.clock.late = InstantNs(1'500'000);
    EXPECT_EQ(bench.step().latched, Fault::kNone) << i;
  }
  EXPECT_EQ(bench.step().latched, Fault::kOverrun);
}

// One tick in twenty may be left out for ever; what stalls a tick for 130 ms every hundred ticks may not,
// though no two overruns follow each other.
TEST(Runner, OverrunsAreJudgedByTheirRateToo) {
  struct {
    std::int64_t late_ns;
    int every;
    Fault fault;
  } const cases[] = {{130'000'000, 100, Fault::kOverrun},
                     {1'400'000, 4, Fault::kOverrun},
                     {1'400'000, 22, Fault::kNone},
                     {150'000'000, 5000, Fault::kNone}};
  for (const auto& wanted : cases) {
    RunnerBench bench;
    while (bench.rig.cycle().mode() != Mode::kActive)
      bench.step(bench.rig.cycle().mode() == Mode::kReady && !bench.rig.asked() ? Command::kActivate
                                                                                : Command::kNone);
    for (int i = 0; i < 20000; ++i) {
      if (i % wanted.every == 1) bench.clock.late = InstantNs(wanted.late_ns);
      bench.step();
    }
    EXPECT_EQ(bench.rig.cycle().latched(), wanted.fault) << wanted.late_ns << " every " << wanted.every;
  }
}

/// An axis at constant speed by the clock: what it reads says when it was read.
class MovingAxes : public SimPlant {
 public:
  MovingAxes(Trajectory& motion, Clock& clock, double mm_per_s)
      : SimPlant(motion, 2, 1, PlantOptions{.gives_motion = false, .faults = {}}),
        clock_(clock),
        speed_(mm_per_s) {}
  HalFault read_axis(std::uint32_t, AxisReading& reading) noexcept override {
    reading = {};
    reading.position =
        AxisPosition(static_cast<std::int64_t>(static_cast<double>(clock_.now().count) * 1e-3 * speed_));
    return HalFault::kNone;
  }

 private:
  Clock& clock_;
  double speed_;
};

// The axis moves at 300 mm/s and may move at 500: a tick that is 1.1 ms late sees 0.63 mm, which no axis does
// in a millisecond, and a speed of 630 mm/s, which it never had.
TEST(Runner, LateTickIsNoJumpAndMakesNoFalseSpeed) {
  const auto image = small_image();
  Roaming motion({{0, 600'000'000}, {0, 200'000'000}}, {InputMicro(20'000'000)}, TimeUs(1000), 0.1, 1);
  LateClock clock;
  MovingAxes axes(motion, clock, 300);
  CycleLimits limits;
  limits.axis[0].own = limits.axis[1].own = true;
  limits.axis[0].limits.step = limits.axis[1].limits.step = 500'000;
  Cycle cycle(image->view, Board{clock, axes, axes, axes}, limits);
  Runner runner(cycle, clock, TimeUs(1000));
  axes.release();
  for (int i = 0; i < 3000; ++i) {
    axes.advance();
    if (i >= 500 && i % 100 == 0) clock.late = InstantNs(1'100'000 + 10'000 * (i / 100));
    runner.step(cycle.mode() == Mode::kReady ? Command::kActivate : Command::kNone);
    if (i > 400) {
      ASSERT_NEAR(static_cast<double>(cycle.axis_state(0).velocity.count), 300e6, 25e6) << i;
    }
  }
  EXPECT_EQ(cycle.health().jumps, 0u);
  EXPECT_EQ(cycle.latched(), Fault::kNone);
  EXPECT_EQ(cycle.mode(), Mode::kActive);
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

// A sleep that ends at the moment of the last wake-up is too short, but the time does not run backwards.
TEST(Runner, TimeThatStandsStillIsNoClockFaultAndOneNanosecondBackIs) {
  for (const int back : {0, 1}) {
    RunnerBench bench;
    while (bench.rig.cycle().mode() != Mode::kReady) bench.step();
    bench.clock.late = InstantNs(-1'000'000 - back);
    EXPECT_EQ(bench.step().latched, back == 0 ? Fault::kNone : Fault::kClock) << back;
  }
}

// 1001 periods after the due time, 1000 ticks are left out one by one. A nanosecond later a new grid begins.
TEST(Runner, LongestStopThatKeepsTheGridLeavesOutAThousandTicks) {
  for (const int more : {0, 1}) {
    RunnerBench bench;
    bench.step();
    bench.clock.late = InstantNs(1'001'000'000 + more);
    bench.step();
    EXPECT_EQ(bench.health().skipped, 1000u) << more;
    EXPECT_EQ(bench.runner.due(), bench.clock.now() + InstantNs(more == 0 ? 0 : 1'000'000));
  }
}

TEST(Runner, WakeUpLaterByMoreThanASecondIsAClockFault) {
  for (const int more : {0, 1}) {
    RunnerBench bench;
    while (bench.rig.cycle().mode() != Mode::kReady) bench.step();
    bench.clock.late = InstantNs(1'000'000'000 + more);
    EXPECT_EQ(bench.step().latched, more == 0 ? Fault::kNone : Fault::kClock) << more;
  }
}

}  // namespace
}  // namespace vernier::runner_test
