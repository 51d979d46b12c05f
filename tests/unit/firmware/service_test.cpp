// SPDX-License-Identifier: GPL-3.0-or-later
// What a service publishes, and how the links learn that the store has done its work.
#include "firmware/core/service.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "tests/unit/firmware/upload_rig.h"
#include "tools/text/error.h"
#include "tools/upload/client.h"

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

/// A service whose store has its own context; `beside` false: a link waits for the store.
class BesideStore : public testing::Test {
 protected:
  explicit BesideStore(const BoardIdentity& identity = {}, bool beside = true) {
    ServiceOptions options;
    options.wiring = {{{"X"}, {"Y"}}, {"T"}};
    options.store_beside = beside;
    options.upload.identity = identity;
    service_ = std::make_unique<Service>(options, Board{clock_, plant_, plant_, plant_}, store_);
    service_->boot();
    service_->serve(link_, TimeUs(0), {.access = LinkAccess::kUpload, .plain_commands = true});
    run(10);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) plant_.advance(), service_->tick();
  }
  std::uint32_t later() { return link_.handler->later(ticket_, reply_); }
  /// The status of the reply; no value: the reply comes later.
  std::optional<LinkStatus> ask(const std::vector<std::uint8_t>& request) {
    const auto size = static_cast<std::uint32_t>(request.size());
    if (link_.handler->answer(request.data(), size, reply_) == CommandHandler::kLater) return std::nullopt;
    return static_cast<LinkStatus>(reply_[2]);
  }
  std::optional<LinkStatus> ask(LinkOp op) { return ask({static_cast<std::uint8_t>(op), 1}); }
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

TEST_F(BesideStore, TakesOneRequestAtATimeAndALinkAnswersTheOthers) {
  ASSERT_EQ(ask(LinkOp::kConfirm), std::nullopt);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(ask(LinkOp::kConfirm), LinkStatus::kNotReady) << "still in the store";
  EXPECT_EQ(ask(LinkOp::kHello), LinkStatus::kDone) << "needs no store";
  EXPECT_TRUE(service_->look_after_store());
  // A client that does not collect its reply has gone: after ten refusals the store is free again.
  for (int i = 0; i < 10; ++i) EXPECT_EQ(ask(LinkOp::kConfirm), LinkStatus::kNotReady) << i;
  EXPECT_EQ(ask(LinkOp::kConfirm), std::nullopt);
}

TEST_F(BesideStore, OnlyASettingThatActsIsAnsweredLater) {
  const auto weight_of = [](std::uint8_t axis) {
    return std::vector<std::uint8_t>{static_cast<std::uint8_t>(LinkOp::kWeight), 1, axis, 0, 0, 0, 0};
  };
  EXPECT_EQ(ask(weight_of(7)), LinkStatus::kBadValue) << "no such axis: nothing will be stored";
  EXPECT_EQ(ask(LinkOp::kHello), LinkStatus::kDone) << "no setting";
  EXPECT_EQ(ask({static_cast<std::uint8_t>(LinkOp::kBegin), 1, 0, 1, 0, 0}), LinkStatus::kRefused)
      << "an upload begins in memory";
  EXPECT_EQ(ask(weight_of(0)), std::nullopt);
}

TEST_F(BesideStore, ReplyToASettingRepeatsOperationAndSequence) {
  const auto weight = static_cast<std::uint8_t>(LinkOp::kWeight);
  ASSERT_EQ(ask({weight, 77, 0, 0, 0, 0, 0}), std::nullopt);
  ticket_ = link_.handler->ticket();
  run(3);
  EXPECT_TRUE(service_->look_after_store());
  ASSERT_NE(later(), CommandHandler::kLater);
  EXPECT_EQ(reply_[0], weight);
  EXPECT_EQ(reply_[1], 77);
  EXPECT_EQ(static_cast<LinkStatus>(reply_[2]), LinkStatus::kDone);
}

TEST_F(BesideStore, HalfARequestHasNoReply) {
  for (const LinkOp op : {LinkOp::kHello, LinkOp::kCommand, LinkOp::kIdentify, LinkOp::kSigned}) {
    const auto code = static_cast<std::uint8_t>(op);
    reply_[0] = 0xaa;
    EXPECT_EQ(link_.handler->answer(&code, 1, reply_), 0u) << int{code};
    EXPECT_EQ(reply_[0], 0xaa) << int{code};
  }
}

TEST_F(BesideStore, RegisterGivesAWholeCommandAndOneUntilTheTickTakesIt) {
  constexpr auto kDeactivate = static_cast<std::uint16_t>(Command::kDeactivate);
  EXPECT_EQ(link_.handler->give(0x100 | kDeactivate), CommandGiven::kRefused) << "not its low byte";
  EXPECT_EQ(service_->exchange().command.load(), Command::kNone);
  EXPECT_EQ(link_.handler->give(kDeactivate), CommandGiven::kLater);
  EXPECT_EQ(link_.handler->give(kDeactivate), CommandGiven::kRefused) << "the tick has not taken the first";
}

TEST_F(BesideStore, RefusalByTheMediumIsAnsweredAtOnceForTheSettingThatItRefused) {
  service_->look_after_store();
  store_.cut_power_after(0);
  for (int setting = 0; setting < 2; ++setting) {
    give(Command::kDeactivate);
    EXPECT_FALSE(service_->look_after_store()) << "the tick has not taken the command";
    EXPECT_EQ(later(), CommandHandler::kLater) << "the medium has refused only earlier settings";
    run(3);
    EXPECT_TRUE(service_->look_after_store());
    ASSERT_EQ(later(), 1u);
    EXPECT_EQ(reply_[0], 1) << "not stored";
  }
  store_.restore_power();
  give(Command::kDeactivate);
  run(3);
  EXPECT_TRUE(service_->look_after_store());
  ASSERT_EQ(later(), 1u);
  EXPECT_EQ(reply_[0], 0) << "stored";
}

TEST_F(BesideStore, SettingThatTheStoreDoesNotTakeIsAnsweredAfterFiveSeconds) {
  service_->look_after_store();
  give(Command::kDeactivate);
  EXPECT_EQ(later(), CommandHandler::kLater);
  clock_.spend(InstantNs(4'999'999'000));
  EXPECT_EQ(later(), CommandHandler::kLater);
  clock_.spend(InstantNs(1'000));
  ASSERT_EQ(later(), 1u);
  EXPECT_EQ(reply_[0], 1) << "not stored";
}

// Also of a board that runs for long: they do not count from its start.
TEST_F(BesideStore, FiveSecondsBeginWithTheFirstSetting) {
  clock_.spend(InstantNs(60'000'000'000));
  give(Command::kDeactivate);
  EXPECT_EQ(later(), CommandHandler::kLater);
  clock_.spend(InstantNs(5'001'000'000));
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

class StoreInTheLink : public BesideStore {
 protected:
  StoreInTheLink() : BesideStore({}, false) {}
};

TEST_F(StoreInTheLink, EveryRequestIsAnsweredAtOnce) {
  EXPECT_EQ(ask({static_cast<std::uint8_t>(LinkOp::kWeight), 1, 0, 0, 0, 0, 0}), LinkStatus::kDone);
  EXPECT_EQ(ask(LinkOp::kConfirm), LinkStatus::kRefused) << "no trial";
  EXPECT_EQ(link_.handler->give(static_cast<std::uint16_t>(Command::kDeactivate)), CommandGiven::kTaken);
}

/// A client that waits for replies; `meanwhile` runs before it looks again.
struct Waits : upload::Transport {
  Waits(CommandHandler& one, const std::function<void()>& act) : handler(one), meanwhile(act) {}
  std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) override {
    std::vector<std::uint8_t> reply(kMaxReplyBytes);
    std::uint32_t size =
        handler.answer(request.data(), static_cast<std::uint32_t>(request.size()), reply.data());
    const std::uint32_t ticket = handler.ticket();
    for (int looks = 0; size == CommandHandler::kLater && looks < 20; ++looks) {
      meanwhile();
      size = handler.later(ticket, reply.data());
    }
    EXPECT_NE(size, CommandHandler::kLater);
    reply.resize(size == CommandHandler::kLater ? 0 : size);
    return reply;
  }
  CommandHandler& handler;
  const std::function<void()>& meanwhile;
};

struct HasKey {
  SigningKey key_ = new_key();
};

/// As above, with a key, and a client that signs with it.
class BesideStoreWithKey : protected HasKey, public BesideStore {
 protected:
  BesideStoreWithKey() : BesideStore(BoardIdentity(key_.public_part())) { board_.sign_with(key_); }
  std::function<void()> meanwhile_ = [this] { service_->look_after_programs(); };
  upload::Client board_{std::make_unique<Waits>(*link_.handler, meanwhile_)};
};

// The reply tells the client that it may upload the next image: the guardian must have ended the trial.
TEST_F(BesideStoreWithKey, RevertIsAnsweredWhenTheGuardianHasEndedTheTrial) {
  int looks = 0, woken = 0;
  const auto store_looks = [&] { ++looks, woken += service_->look_after_store() ? 1 : 0; };
  meanwhile_ = store_looks;
  EXPECT_THROW(board_.revert(), text::LimitNotMet) << "no trial";
  EXPECT_EQ(looks, 1) << "nothing to wait for";
  meanwhile_ = [&] { service_->look_after_programs(); };
  const auto image = make_upload(small_image_bytes(2e-5), key_, 5, 0);
  board_.upload(image, [](double) {});
  board_.confirm();
  meanwhile_();
  run(3);
  meanwhile_();
  board_.upload(make_upload(small_image_bytes(3e-5), key_, 6, 0), [](double) {});
  meanwhile_();
  ASSERT_EQ(service_->uploader().programs().trial(), Trial::kRunning);
  // WHEN the guardian runs only after the store has looked three times
  looks = woken = 0;
  meanwhile_ = [&] {
    if (looks == 3) {
      EXPECT_EQ(woken, 0) << "no reply yet";
      service_->guard();
    }
    store_looks();
  };
  board_.revert();
  EXPECT_EQ(looks, 4);
  EXPECT_EQ(woken, 1);
  // AND a second revert finds no trial, and does not wait for one
  looks = 0, meanwhile_ = store_looks;
  EXPECT_THROW(board_.revert(), text::LimitNotMet);
  EXPECT_EQ(looks, 1);
}

// A link keeps the connection of a sender that signs: a request for a challenge proves nothing.
TEST_F(BesideStoreWithKey, OnlyASignedRequestCountsAsSigned) {
  for (int round = 0; round < 2; ++round) {
    for (const LinkOp op : {LinkOp::kChallenge, LinkOp::kIdentify, LinkOp::kHello}) {
      ask(op);
      EXPECT_FALSE(link_.handler->was_signed()) << static_cast<int>(op) << ", round " << round;
    }
    bool was_signed = false;
    meanwhile_ = [&] {
      was_signed = link_.handler->was_signed();
      run(3);
      service_->look_after_programs();
    };
    board_.weight(0, 0.5);
    EXPECT_TRUE(was_signed);
  }
}

TEST_F(BesideStoreWithKey, OnlyTheRevertItselfWaitsForTheEndOfATrial) {
  const auto image = make_upload(small_image_bytes(2e-5), key_, 5, 0);
  board_.upload(image, [](double) {});
  board_.confirm();
  meanwhile_();
  board_.upload(make_upload(small_image_bytes(3e-5), key_, 6, 0), [](double) {});
  meanwhile_();
  // GIVEN a revert that the guardian has not executed yet
  ASSERT_EQ(const_cast<Uploader&>(service_->uploader()).revert().fault, UploadFault::kNone);
  ASSERT_TRUE(service_->uploader().programs().giving_up());
  meanwhile_ = [&] { service_->look_after_store(); };
  EXPECT_EQ(board_.confirmed([](double) {}), image);
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

/// A probe that is never touched.
struct QuietLine : ProbeLine {
  HalFault read_edge(ProbeEdge&) noexcept override { return HalFault::kNoReading; }
  InstantNs resolution() const noexcept override { return InstantNs(1000); }
};

// Each table of the board is full: an index beyond an array ends this test under the sanitizers.
TEST(ServiceState, BoardOfTheMostAxesAndInputsTicks) {
  ServiceOptions options;
  std::vector<RoamingAxis> ranges;
  std::vector<InputMicro> values;
  for (std::size_t i = 0; i < kMaxAxes; ++i) {
    options.wiring.axes.push_back({("A" + std::to_string(i)).c_str()});
    ranges.push_back({0, 200'000'000});
  }
  for (std::size_t i = 0; i < kMaxInputs; ++i) {
    options.wiring.inputs.push_back(("T" + std::to_string(i)).c_str());
    values.emplace_back(21'000'000);
  }
  PatternClock clock;
  Roaming motion(ranges, values, TimeUs(1000), 0.1, 1);
  SimPlant plant(motion, kMaxAxes, kMaxInputs, {});
  SimSlotStore store(1 << 16);
  QuietLine line;
  Service service(options, Board{clock, plant, plant, plant, &line}, store);
  service.boot();
  for (int i = 0; i < 10; ++i) plant.advance(), service.tick();
  StateRecord state;
  ASSERT_TRUE(service.exchange().state.read(state));
  for (std::uint32_t axis = 0; axis < kMaxAxes; ++axis)
    EXPECT_EQ(state.axis_weight[axis], kFullWeight.count) << axis;
  EXPECT_EQ(service.cycle().health().ticks, 10u);
  KeptHandler link;
  service.serve(link, TimeUs(0), {});
  std::uint16_t registers[kLiveRegisters];
  link.handler->fill_registers(registers);
  EXPECT_EQ(registers[kLiveAxisWeights + static_cast<int>(kMaxAxes) - 1], 10'000);
  EXPECT_EQ(registers[kLiveInputs + 2 * static_cast<int>(kMaxInputs) - 1], 21'000) << "thousandths";
}

TEST(ServiceState, TickNamesTheAxesThatAreAtALimit) {
  const SigningKey key = new_key();
  SimSlotStore store(1 << 16);
  UploadRig rig(store, key);
  rig.send(make_upload(small_image_bytes(2e-4), key, 5, 0));
  int held = 0, free = 0;
  for (int i = 0; i < 8000; ++i) {
    rig.run(1);
    TickRecord record;
    ASSERT_TRUE(rig.service().exchange().ticks.read(rig.service().exchange().ticks.count() - 1, record));
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
      constexpr auto kLimits = kAtImageLimit | kAtBoardLimit | kAtOutputLimit;
      const bool at_limit = (rig.service().cycle().limits(axis) & kLimits) != 0;
      ASSERT_EQ((record.saturated >> axis & 1) != 0, at_limit) << "axis " << axis << ", tick " << i;
      ++(at_limit ? held : free);
    }
  }
  EXPECT_GT(held, 0);
  EXPECT_GT(free, 0);
}

}  // namespace
}  // namespace vernier::service_test
