// SPDX-License-Identifier: GPL-3.0-or-later
// Ticks that follow the controller's sync: in step with a clock that runs off, through lost and early signs.
#include <gtest/gtest.h>

#include <deque>

#include "firmware/core/cycle/runner.h"
#include "hal/sim/sim_clock.h"
#include "tests/unit/firmware/rig.h"

namespace vernier::sync_test {
namespace {

/// Signs at moments that the test gives.
class Signs : public TickSync {
 public:
  explicit Signs(SimClock& clock) : clock_(clock) {}
  HalFault wait_for_sync(InstantNs latest) noexcept override {
    if (broken) return HalFault::kRefused;
    if (at.empty() || at.front() > std::max(latest, clock_.now()))
      return clock_.sleep_until(latest), HalFault::kNoReading;
    clock_.sleep_until(at.front());
    while (!at.empty() && at.front() <= clock_.now()) at.pop_front();
    return HalFault::kNone;
  }
  std::deque<InstantNs> at;
  bool broken = false;

 private:
  SimClock& clock_;
};

struct SyncBench {
  Rig rig;
  SimClock clock;
  Signs signs{clock};
  Runner runner{rig.cycle(), clock, TimeUs(1000), &signs, TimeUs(20'000)};
  InstantNs step() {
    rig.plant().advance();
    report = runner.step(Command::kNone);
    clock.spend(InstantNs(1000));
    return runner.woke();
  }
  TickReport report{};
  Health& health() { return rig.cycle().health(); }
};

TEST(Sync, TicksAreInStepWithAControllerWhoseClockRunsOff) {
  for (const std::int64_t period : {999'900, 1'000'100}) {  // 100 ppm
    SyncBench bench;
    for (int i = 1; i <= 20'000; ++i) bench.signs.at.emplace_back(i * period);
    const InstantNs first = bench.step();  // the slower controller's first sign is later than the own clock
    EXPECT_EQ(first.count, std::min<std::int64_t>(period, 1'000'000));
    for (int i = 2; i <= 20'000; ++i) ASSERT_EQ(bench.step(), InstantNs(i * period));
    EXPECT_EQ(bench.health().skipped, 0u);
    EXPECT_EQ(bench.health().overruns, 0u);
    EXPECT_EQ(bench.runner.lost_syncs(), 0u);
    EXPECT_TRUE(bench.runner.in_step());
  }
}

TEST(Sync, LeftOutSignIsATickThatWasLeftOut) {
  SyncBench bench;
  for (int i = 1; i <= 10; ++i)
    if (i != 5) bench.signs.at.emplace_back(i * 1'000'000);
  for (int i = 1; i <= 9; ++i) bench.step();
  EXPECT_EQ(bench.runner.woke(), InstantNs(10'000'000));
  EXPECT_EQ(bench.health().skipped, 1u);
  EXPECT_EQ(bench.runner.time(), TimeUs(10'000)) << "t goes on with the controller's cycles";
  EXPECT_EQ(bench.runner.lost_syncs(), 0u);
}

TEST(Sync, OwnClockTakesOverAndGivesBack) {
  SyncBench bench;
  bench.signs.at = {InstantNs(1'000'000), InstantNs(2'000'000)};
  bench.step(), bench.step();
  EXPECT_EQ(bench.step(), InstantNs(23'000'000)) << "due at 3 ms, and 20 ms of patience";
  EXPECT_FALSE(bench.runner.in_step());
  InstantNs last = bench.runner.woke();
  for (int i = 0; i < 50; ++i) {
    const InstantNs woke = bench.step();
    ASSERT_LE((woke - last).count, 1'001'000) << "by the own clock";
    last = woke;
  }
  EXPECT_EQ(bench.runner.lost_syncs(), 1u);
  EXPECT_NE(bench.report.latched, Fault::kClock);
  bench.signs.at.push_back(last + InstantNs(700'000));
  EXPECT_EQ(bench.step(), last + InstantNs(700'000)) << "and in step again";
  EXPECT_TRUE(bench.runner.in_step());
}

TEST(Sync, FloodOfSignsStartsNoMoreTicks) {
  SyncBench bench;
  for (int i = 1; i < 100'000; ++i) bench.signs.at.emplace_back(i * 10'000);  // 100 kHz
  InstantNs last = bench.step();
  for (int i = 0; i < 400; ++i) {
    const InstantNs woke = bench.step();
    ASSERT_GE((woke - last).count, 490'000) << "half a period apart at least";
    last = woke;
  }
}

/// A device whose signs never end, at one and the same instant.
struct Endless : TickSync {
  HalFault wait_for_sync(InstantNs) noexcept override { return ++signs, HalFault::kNone; }
  int signs = 0;
};

TEST(Sync, TickOfEndlessEarlySignsIsStartedByTheClockAfter64) {
  Rig rig;
  SimClock clock;
  Endless endless;
  Runner runner{rig.cycle(), clock, TimeUs(1000), &endless, TimeUs(20'000)};
  rig.plant().advance();
  runner.step(Command::kNone);
  EXPECT_EQ(endless.signs, 64);
  EXPECT_EQ(runner.woke(), InstantNs(1'000'000));
  EXPECT_FALSE(runner.in_step());
}

TEST(Sync, BrokenDeviceLeavesTheTicksToTheClock) {
  SyncBench bench;
  bench.signs.broken = true;
  for (int i = 1; i <= 100; ++i) ASSERT_EQ(bench.step(), InstantNs(i * 1'000'000));
}

TEST(Sync, StandingStillIsAFaultOfTheClock) {
  SyncBench bench;
  for (int i = 1; i <= 300; ++i) bench.signs.at.emplace_back(i * 1'000'000);
  for (int i = 1; i <= 300; ++i) bench.step();
  ASSERT_EQ(bench.report.mode, Mode::kReady);
  bench.clock.spend(InstantNs(2'000'000'000));
  bench.signs.at.push_back(bench.clock.now());
  bench.step();
  EXPECT_EQ(bench.report.latched, Fault::kClock);
}

// The loop of a tick is limited to a thousand periods. The schedule starts again with the signal.
TEST(Sync, NoMoreThanAThousandLeftOutSignsAreCounted) {
  Rig rig;
  SimClock clock;
  Signs signs(clock);
  Runner runner(rig.cycle(), clock, TimeUs(500), &signs, TimeUs(20'000));
  signs.at = {InstantNs(500'000)};
  runner.step(Command::kNone);
  clock.spend(InstantNs(900'000'000));  // 1800 periods, and less than a step of the clock
  signs.at = {clock.now(), clock.now() + InstantNs(500'000)};
  const InstantNs late = clock.now();
  runner.step(Command::kNone);
  EXPECT_EQ(rig.cycle().health().skipped, 1000u);
  EXPECT_EQ(runner.woke(), late);
  runner.step(Command::kNone);
  EXPECT_EQ(runner.woke(), late + InstantNs(500'000));
  EXPECT_EQ(rig.cycle().health().skipped, 1000u);
}

struct SignAt {
  std::int64_t after_due_ns;  // of a sign, from the moment at which it is due
  std::int64_t woke_ns;       // beginning of the tick, from the same moment
  std::uint64_t skipped;
};

// A sign within half a period of the due time starts the tick; an earlier one is ignored, and a later one
// shows that the controller left out a sign.
TEST(Sync, SignAtHalfAPeriodStartsTheTickAndOneNanosecondMoreDiffers) {
  constexpr SignAt kCases[] = {{-500'000, -500'000, 0}, {-500'001, 0, 0},          {500'000, 500'000, 0},
                               {500'001, 500'001, 1},   {1'500'000, 1'500'000, 1}, {1'500'001, 1'500'001, 2}};
  for (const SignAt& wanted : kCases) {
    SyncBench bench;
    for (int i = 1; i <= 5; ++i) bench.signs.at.emplace_back(i * 1'000'000);
    bench.signs.at.emplace_back(6'000'000 + wanted.after_due_ns);
    if (wanted.after_due_ns < wanted.woke_ns) bench.signs.at.emplace_back(6'000'000);
    for (int i = 1; i <= 5; ++i) bench.step();
    EXPECT_EQ(bench.step(), InstantNs(6'000'000 + wanted.woke_ns)) << wanted.after_due_ns;
    EXPECT_EQ(bench.health().skipped, wanted.skipped) << wanted.after_due_ns;
  }
}

TEST(Sync, SignThatIsLaterByMoreThanASecondIsAClockFault) {
  for (const int more : {0, 1}) {
    SyncBench bench;
    for (int i = 1; i <= 300; ++i) bench.signs.at.emplace_back(i * 1'000'000);
    for (int i = 1; i <= 300; ++i) bench.step();
    ASSERT_EQ(bench.report.mode, Mode::kReady);
    bench.clock.sleep_until(InstantNs(1'301'000'000 + more));  // the next one is due at 301 ms
    bench.signs.at.push_back(bench.clock.now());
    bench.step();
    EXPECT_EQ(bench.report.latched, more == 0 ? Fault::kNone : Fault::kClock) << more;
  }
}

}  // namespace
}  // namespace vernier::sync_test
