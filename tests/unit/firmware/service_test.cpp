// SPDX-License-Identifier: GPL-3.0-or-later
// What a service publishes, and how the links learn that the store has done its work.
#include "firmware/core/service.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/firmware/upload_rig.h"

namespace vernier::service_test {
namespace {

/// A clock on which each sleep ends late by a time of a given pattern.
class PatternClock : public Clock {
 public:
  InstantNs now() noexcept override { return now_; }
  HalFault sleep_until(InstantNs due) noexcept override {
    const int k = calls_++ % 1000;
    now_ = std::max(now_, due) + InstantNs(k < 300 ? 1'000 : k < 700 ? 5'000 : k < 992 ? 20'000 : 100'000);
    return HalFault::kNone;
  }
  void spend(InstantNs time) { now_ = now_ + time; }

 private:
  InstantNs now_{1'000'000};
  int calls_ = 0;
};

/// A link that keeps the handler of its requests.
struct KeptHandler : CommandLink {
  HalFault serve(CommandHandler& one, TimeUs) noexcept override {
    handler = &one;
    return HalFault::kNone;
  }
  CommandHandler* handler = nullptr;
};

/// A service whose store has its own context.
class BesideStore : public testing::Test {
 protected:
  BesideStore() {
    ServiceOptions options;
    options.wiring = {{{"X"}, {"Y"}}, {"T"}};
    options.store_beside = true;
    service_ = std::make_unique<Service>(options, Board{clock_, plant_, plant_, plant_}, store_);
    service_->boot();
    service_->serve(link_, TimeUs(0), {.access = LinkAccess::kUpload, .plain_commands = true});
    run(10);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) plant_.advance(), service_->tick();
  }
  std::uint32_t later() { return link_.handler->later(ticket_, reply_); }
  void give(Command command) {
    ASSERT_EQ(link_.handler->give(static_cast<std::uint16_t>(command)), CommandGiven::kLater);
    ticket_ = link_.handler->ticket();
  }
  PatternClock clock_;
  Roaming motion_{{{0, 600'000'000}, {0, 200'000'000}}, {InputMicro(21'000'000)}, TimeUs(1000), 0.1, 1};
  SimPlant plant_{motion_, 2, 1, {}};
  SimSlotStore store_{1 << 16};
  std::unique_ptr<Service> service_;
  KeptHandler link_;
  std::uint8_t reply_[kMaxReplyBytes] = {};
  std::uint32_t ticket_ = 0;
};

TEST_F(BesideStore, LinksAreWokenOnceWhenASettingIsStored) {
  EXPECT_FALSE(service_->look_after_store()) << "nothing was set";
  give(Command::kDeactivate);
  EXPECT_FALSE(service_->look_after_store()) << "the tick has not taken the command";
  EXPECT_EQ(later(), CommandHandler::kLater);
  run(3);
  EXPECT_TRUE(service_->look_after_store());
  EXPECT_FALSE(service_->look_after_store());
  ASSERT_EQ(later(), 1u);
  EXPECT_EQ(reply_[0], 0) << "stored";
}

TEST_F(BesideStore, LinksAreWokenWhenARequestIsDone) {
  const std::uint8_t request[] = {static_cast<std::uint8_t>(LinkOp::kConfirm), 1};
  ASSERT_EQ(link_.handler->answer(request, sizeof(request), reply_), CommandHandler::kLater);
  ticket_ = link_.handler->ticket();
  EXPECT_EQ(later(), CommandHandler::kLater);
  EXPECT_TRUE(service_->look_after_store());
  EXPECT_NE(later(), CommandHandler::kLater);
  EXPECT_FALSE(service_->look_after_store());
}

TEST_F(BesideStore, SettingThatTheStoreDoesNotTakeIsAnsweredAfterFiveSeconds) {
  service_->look_after_store();
  give(Command::kDeactivate);
  EXPECT_EQ(later(), CommandHandler::kLater);
  clock_.spend(InstantNs(4'999'000'000));
  EXPECT_EQ(later(), CommandHandler::kLater);
  clock_.spend(InstantNs(2'000'000));
  ASSERT_EQ(later(), 1u);
  EXPECT_EQ(reply_[0], 1) << "not stored";
}

// A store that goes on, though slowly, is waited for.
TEST_F(BesideStore, EachSettingThatIsStoredBeginsTheFiveSecondsAnew) {
  service_->look_after_store();
  give(Command::kDeactivate);
  EXPECT_EQ(later(), CommandHandler::kLater);
  clock_.spend(InstantNs(3'000'000'000));
  run(1);  // the tick that can have taken the command is the next one
  service_->look_after_store();
  EXPECT_EQ(later(), CommandHandler::kLater);
  clock_.spend(InstantNs(3'000'000'000));
  EXPECT_EQ(later(), CommandHandler::kLater);
  clock_.spend(InstantNs(2'100'000'000));
  ASSERT_EQ(later(), 1u);
  EXPECT_EQ(reply_[0], 1) << "not stored";
}

TEST_F(BesideStore, PercentilesArePublishedOfTheWholeTimes) {
  run(20'000);
  HealthRecord health;
  ASSERT_TRUE(service_->exchange().health.read(health));
  const Histogram& late = service_->runner().times().latency;
  EXPECT_EQ(health.latency_ns[0], late.percentile_ns(500'000));
  EXPECT_EQ(health.latency_ns[1], late.percentile_ns(990'000));
  EXPECT_EQ(health.latency_ns[2], late.percentile_ns(999'000));
  // The pattern of the clock: the three are far apart, and far from the smallest.
  EXPECT_NEAR(static_cast<double>(health.latency_ns[0]), 5e3, 200);
  EXPECT_NEAR(static_cast<double>(health.latency_ns[1]), 20e3, 800);
  EXPECT_NEAR(static_cast<double>(health.latency_ns[2]), 100e3, 4000);
}

TEST(ServiceState, IsThatOfTheAxesOfTheBoardOnly) {
  const SigningKey key = new_key();
  SimSlotStore store(1 << 16);
  UploadRig rig(store, key);
  rig.send(make_upload(small_image_bytes(2e-5), key, 5, 0));
  rig.run(3000);
  StateRecord state;
  ASSERT_TRUE(rig.service().exchange().state.read(state));
  for (std::uint32_t axis = 0; axis < 2; ++axis) {
    EXPECT_NE(state.wanted[axis], 0);
    EXPECT_EQ(state.wanted[axis], rig.service().cycle().wanted(axis).count);
    EXPECT_EQ(state.achieved[axis], rig.service().cycle().achieved(axis).count);
    EXPECT_EQ(state.axis_weight[axis], kFullWeight.count);
  }
  for (std::uint32_t axis = 2; axis < kMaxAxes; ++axis) EXPECT_EQ(state.axis_weight[axis], 0) << "no axis";
}

}  // namespace
}  // namespace vernier::service_test
