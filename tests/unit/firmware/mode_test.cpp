// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/core/cycle/mode.h"

#include <gtest/gtest.h>

#include <memory>

namespace vernier::mode_test {
namespace {

/// A mode control whose corrections follow the weight at once.
struct Bench {
  ModeControl control;
  std::unique_ptr<Health> health = std::make_unique<Health>();

  void tick(Command command = Command::kNone, Fault fault = Fault::kNone, bool complete = true,
            bool settled = true) {
    control.before(command, fault, complete, *health);
    control.after(Fault::kNone, control.weight() == WeightQ16{}, settled, *health);
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  void to_active() {
    ticks(kCheckTicks);
    tick(Command::kActivate);
    ticks(kRampTicks);
  }
};

TEST(ModeControl, BecomesReadyAfterTheCheckAndNotBefore) {
  Bench bench;
  EXPECT_EQ(bench.control.mode(), Mode::kBoot);
  bench.ticks(kCheckTicks - 1);
  EXPECT_EQ(bench.control.mode(), Mode::kChecking);
  bench.tick();
  EXPECT_EQ(bench.control.mode(), Mode::kReady);
  EXPECT_EQ(bench.control.weight(), WeightQ16{});
}

TEST(ModeControl, FaultWhileCheckingStartsTheCheckAgainAndDoesNotLatch) {
  Bench bench;
  bench.ticks(kCheckTicks - 1);
  bench.tick(Command::kNone, Fault::kInputMissing);
  bench.ticks(kCheckTicks - 1);
  EXPECT_EQ(bench.control.mode(), Mode::kChecking);
  EXPECT_EQ(bench.control.latched(), Fault::kNone);
  bench.tick();
  EXPECT_EQ(bench.control.mode(), Mode::kReady);
}

TEST(ModeControl, SilentDeviceKeepsItChecking) {
  Bench bench;
  for (int i = 0; i < 1000; ++i) bench.tick(Command::kActivate, Fault::kNone, false);
  EXPECT_EQ(bench.control.mode(), Mode::kChecking);
  EXPECT_EQ(bench.health->refused_commands, 1000u);
}

TEST(ModeControl, ActiveBeginsWhenTheCorrectionIsIn) {
  Bench bench;
  bench.ticks(kCheckTicks);
  bench.tick(Command::kActivate);
  bench.ticks(kRampTicks - 2);
  EXPECT_EQ(bench.control.mode(), Mode::kReady);
  for (int i = 0; i < 50; ++i) bench.tick(Command::kNone, Fault::kNone, true, false);  // still slewing
  EXPECT_EQ(bench.control.mode(), Mode::kReady);
  EXPECT_EQ(bench.control.weight(), kFullWeight);
  bench.tick();
  EXPECT_EQ(bench.control.mode(), Mode::kActive);
}

TEST(ModeControl, FaultRampsOutLatchesAndNeedsACommand) {
  Bench bench;
  bench.to_active();
  ASSERT_EQ(bench.control.mode(), Mode::kActive);
  bench.tick(Command::kNone, Fault::kPositionJump);
  EXPECT_EQ(bench.control.mode(), Mode::kRampOut);
  bench.tick(Command::kNone, Fault::kInputMissing);  // a second fault does not overwrite the first
  bench.ticks(kRampTicks);
  EXPECT_EQ(bench.control.mode(), Mode::kFaulted);
  EXPECT_EQ(bench.control.latched(), Fault::kPositionJump);
  EXPECT_EQ(bench.health->faults, 1u);
  for (int i = 0; i < 500; ++i) bench.tick(Command::kActivate);
  EXPECT_EQ(bench.control.mode(), Mode::kFaulted);
  bench.tick(Command::kClearFault);
  EXPECT_EQ(bench.control.mode(), Mode::kChecking);
  EXPECT_EQ(bench.control.latched(), Fault::kNone);
  EXPECT_EQ(bench.health->faults, 1u) << "counters only go up";
}

TEST(ModeControl, DeactivatingRampsOutToReady) {
  Bench bench;
  bench.to_active();
  bench.tick(Command::kDeactivate);
  EXPECT_EQ(bench.control.mode(), Mode::kRampOut);
  bench.ticks(kRampTicks);
  EXPECT_EQ(bench.control.mode(), Mode::kReady);
  EXPECT_EQ(bench.control.latched(), Fault::kNone);
}

TEST(ModeControl, FaultWhileBringingInTakesItOutAgain) {
  Bench bench;
  bench.ticks(kCheckTicks);
  bench.tick(Command::kActivate);
  bench.ticks(kRampTicks / 2);
  const WeightQ16 half = bench.control.weight();
  bench.tick(Command::kNone, Fault::kOverrun);
  EXPECT_LT(bench.control.weight(), half);
  bench.ticks(kRampTicks);
  EXPECT_EQ(bench.control.mode(), Mode::kFaulted);
}

TEST(ModeControl, NamesAreDistinct) {
  EXPECT_STREQ(name_of(Mode::kRampOut), "ramp-out");
  EXPECT_STREQ(name_of(Fault::kPositionFrozen), "position-frozen");
}

}  // namespace
}  // namespace vernier::mode_test
