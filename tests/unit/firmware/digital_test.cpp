// SPDX-License-Identifier: GPL-3.0-or-later
// The lines from and to the machine's controller: enable lets the correction in, healthy says that it may be
// believed.
#include <gtest/gtest.h>

#include "tests/unit/firmware/upload_rig.h"

namespace vernier::digital_test {

using namespace vernier::upload;
namespace {

struct Switch : DigitalInput, DigitalOutput {
  HalFault read_line(bool& value) noexcept override {
    if (broken) return HalFault::kRefused;
    value = on;
    return HalFault::kNone;
  }
  HalFault write_line(bool value) noexcept override {
    ++writes;
    if (broken) return HalFault::kRefused;
    on = value;
    return HalFault::kNone;
  }
  bool on = false, broken = false;
  int writes = 0;
};

class Digital : public testing::Test {
 protected:
  Digital() {
    rig_.send(make_upload(small_image_bytes(2e-5), key_, 5, 0));
    rig_.uploader().confirm();
  }
  Mode mode() { return rig_.service().cycle().mode(); }
  SigningKey key_ = new_key();
  SimSlotStore store_{1 << 16};
  Switch enable_, healthy_;
  UploadRig rig_{store_, key_, TimeUs(5'000'000), &enable_, &healthy_};
};

TEST_F(Digital, CorrectionComesInAndGoesOutWithTheEnableLine) {
  rig_.run(3000);
  EXPECT_EQ(mode(), Mode::kReady);
  EXPECT_EQ(rig_.plant().written(1), AxisTravel{});
  enable_.on = true;
  rig_.run(3000);
  EXPECT_EQ(mode(), Mode::kActive);
  EXPECT_NE(rig_.plant().written(1), AxisTravel{});
  enable_.on = false;
  rig_.run(3000);
  EXPECT_EQ(mode(), Mode::kReady);
  EXPECT_EQ(rig_.plant().written(1), AxisTravel{});
  enable_.on = true;
  rig_.run(3000);
  EXPECT_EQ(mode(), Mode::kActive) << "comes in again";
  EXPECT_EQ(rig_.service().cycle().health().refused_commands, 0u);
  EXPECT_LE(rig_.worst_step(0), 500) << "maxslew of the small machine, 0.5 mm/s";
  EXPECT_LE(rig_.worst_step(1), 2000);
}

TEST_F(Digital, EnableLineThatCannotBeReadIsOff) {
  enable_.on = true;
  rig_.run(3000);
  ASSERT_EQ(mode(), Mode::kActive);
  enable_.broken = true;
  rig_.run(3000);
  EXPECT_EQ(mode(), Mode::kReady);
}

TEST_F(Digital, NobodyActivatesAgainstTheEnableLine) {
  rig_.run(500);
  ASSERT_EQ(mode(), Mode::kReady);
  const_cast<Exchange&>(rig_.service().exchange()).command = Command::kActivate;
  rig_.run(500);
  EXPECT_EQ(mode(), Mode::kReady);
  EXPECT_EQ(rig_.service().cycle().weight(), WeightQ16{});
  EXPECT_EQ(rig_.service().cycle().health().refused_commands, 1u) << "the operator learns of it";
}

// The line came on, and the board forgot that an operator had held the corrections.
TEST_F(Digital, HeldCorrectionStaysOutWhenTheLineComesOnAgain) {
  enable_.on = true;
  rig_.run(3000);
  const_cast<Exchange&>(rig_.service().exchange()).command = Command::kHold;
  rig_.run(500);
  ASSERT_TRUE(rig_.service().cycle().holding());
  enable_.on = false;
  rig_.run(3000);
  enable_.on = true;
  rig_.run(3000);
  EXPECT_EQ(mode(), Mode::kReady);
  EXPECT_EQ(rig_.plant().written(1), AxisTravel{});
  UploadRig again(store_, key_, TimeUs(5'000'000), &enable_, &healthy_);
  again.run(3000);
  EXPECT_EQ(again.service().cycle().mode(), Mode::kReady);
  const_cast<Exchange&>(again.service().exchange()).command = Command::kActivate;
  again.run(3000);
  EXPECT_EQ(again.service().cycle().mode(), Mode::kActive);
}

// The line that came on made the board forget that it had been active: clearing the fault activated it.
TEST_F(Digital, ClearedFaultWaitsForTheActivationAlthoughTheLineComesOn) {
  const auto give = [](UploadRig& rig, Command command) {
    const_cast<Exchange&>(rig.service().exchange()).command = command;
    rig.run(3000);
  };
  const auto expect_wait = [&](UploadRig& rig) {
    enable_.on = false;
    rig.run(1000);
    ASSERT_EQ(rig.service().cycle().mode(), Mode::kFaulted);
    enable_.on = true;
    rig.run(10);
    give(rig, Command::kClearFault);
    EXPECT_EQ(rig.service().cycle().mode(), Mode::kReady);
    EXPECT_EQ(rig.plant().written(1), AxisTravel{});
    give(rig, Command::kActivate);
    EXPECT_EQ(rig.service().cycle().mode(), Mode::kActive);
  };
  const auto fault = [](UploadRig& rig) {
    rig.service().cycle().tick(TimeUs(1), Command::kNone, Fault::kOverrun);
    rig.run(1000);
  };
  enable_.on = true;
  rig_.run(3000);
  ASSERT_EQ(mode(), Mode::kActive);
  fault(rig_);
  expect_wait(rig_);
  // A fault that a start restored.
  fault(rig_);
  UploadRig again(store_, key_, TimeUs(5'000'000), &enable_, &healthy_);
  ASSERT_EQ(again.service().cycle().latched(), Fault::kOverrun);
  expect_wait(again);
}

TEST_F(Digital, FaultCanBeClearedWhileTheLineIsOffButNotAfterTheEnd) {
  const auto clear = [&] {
    const_cast<Exchange&>(rig_.service().exchange()).command = Command::kClearFault;
    rig_.run(500);
  };
  const auto fault = [&] {
    rig_.service().cycle().tick(TimeUs(1), Command::kNone, Fault::kOverrun);
    enable_.on = false;
    rig_.run(1000);
    ASSERT_EQ(mode(), Mode::kFaulted);
  };
  enable_.on = true;
  rig_.run(3000);
  fault();
  clear();
  EXPECT_EQ(mode(), Mode::kReady);
  EXPECT_EQ(rig_.plant().written(1), AxisTravel{});
  fault();
  rig_.service().end();
  clear();
  EXPECT_EQ(mode(), Mode::kFaulted);
}

TEST_F(Digital, HealthySaysSoFromReadyUntilAFault) {
  enable_.on = true;
  rig_.run(50);
  EXPECT_FALSE(healthy_.on) << "still checking";
  rig_.run(2000);
  EXPECT_TRUE(healthy_.on);
  EXPECT_LE(healthy_.writes, 2) << "only what changes is written";
  rig_.service().end();
  rig_.run(1);
  EXPECT_FALSE(healthy_.on);
}

TEST_F(Digital, HealthyLineThatRefusesIsTriedAgain) {
  healthy_.broken = true;
  rig_.run(2000);
  EXPECT_FALSE(healthy_.on);
  healthy_.broken = false;
  rig_.run(1);
  EXPECT_TRUE(healthy_.on);
}

// A line that stands still, high or low, says that nothing toggles it any more: a tick that hangs is seen by
// a relay.
TEST(DigitalPump, TogglesWhileAllIsWellAndStandsOtherwise) {
  const SigningKey key = new_key();
  SimSlotStore store(1 << 16);
  Switch healthy;
  UploadRig rig(store, key, TimeUs(5'000'000), nullptr, &healthy, 10);
  rig.run(500);
  EXPECT_EQ(healthy.writes, 1) << "nothing runs: it is off";
  rig.send(make_upload(small_image_bytes(2e-5), key, 5, 0));
  rig.run(2000);
  const int before = healthy.writes;
  rig.run(1000);
  EXPECT_EQ(healthy.writes - before, 100);
  rig.service().end();
  rig.run(20);
  const int ended = healthy.writes;
  rig.run(1000);
  EXPECT_EQ(healthy.writes, ended);
  EXPECT_FALSE(healthy.on);
}

// The relay did not see an edge that the line refused. It needs the next edge in time.
TEST(DigitalPump, EdgeThatTheLineRefusesComesInTheNextTickThatItTakes) {
  const SigningKey key = new_key();
  SimSlotStore store(1 << 16);
  Switch healthy;
  UploadRig rig(store, key, TimeUs(5'000'000), nullptr, &healthy, 10);
  rig.send(make_upload(small_image_bytes(2e-5), key, 5, 0));
  rig.run(2000);
  for (const bool before = healthy.on; healthy.on == before;) rig.run(1);
  const bool level = healthy.on;
  healthy.broken = true;
  rig.run(15);
  healthy.broken = false;
  rig.run(1);
  EXPECT_NE(healthy.on, level);
  rig.run(9);
  EXPECT_NE(healthy.on, level);
  rig.run(1);
  EXPECT_EQ(healthy.on, level) << "ten ticks after the edge that the line took";
}

}  // namespace
}  // namespace vernier::digital_test
