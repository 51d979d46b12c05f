// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/hatch.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <thread>
#include <vector>

#include "firmware/linuxcnc/hatch_link.h"
#include "firmware/linuxcnc/remote_store.h"
#include "firmware/linuxcnc/store_server.h"
#include "hal/sim/sim_slot_store.h"
#include "tables/link_format.h"

namespace vernier::hatch_test {
namespace {

/// A process that has ended, with a parent that has not asked for it yet.
pid_t ended_child() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  siginfo_t info;
  ::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOWAIT);
  return child;
}

TEST(Hatch, ProcessThatOnlyWaitsForItsParentIsGone) {
  const pid_t child = ended_child();
  EXPECT_FALSE(process_lives(child));
  ::waitpid(child, nullptr, 0);
  EXPECT_FALSE(process_lives(child));
  EXPECT_TRUE(process_lives(::getpid()));
}

TEST(Hatch, CallToAPeerThatIsGoneIsWithdrawnAndTheNextOneGoesThrough) {
  const auto call = std::make_unique<Call>();
  std::atomic<bool> stop{false};
  const pid_t child = ended_child();
  EXPECT_FALSE(make_call(*call, child, stop));
  EXPECT_FALSE(is_asked(*call));
  ::waitpid(child, nullptr, 0);
  std::thread peer([&] {
    while (!wait_for_call(*call, TimeUs(10'000))) {
    }
    call->result = 7;
    answer_call(*call);
  });
  EXPECT_TRUE(make_call(*call, ::getpid(), stop));
  EXPECT_EQ(call->result, 7);
  peer.join();
}

TEST(Hatch, StoreBehindItKeepsWhatIsWritten) {
  const auto hatch = std::make_unique<Hatch>();
  hatch->helper = ::getpid();
  SimSlotStore slots(1 << 16);
  const std::vector<std::uint8_t> given(9000, 0x5a);
  StoreServer server(hatch->store, slots, given);
  std::atomic<bool> stop{false};
  std::thread helper([&] {
    while (!stop) server.serve(TimeUs(5'000));
  });
  RemoteStore store(*hatch, 1 << 16, stop);
  std::vector<std::uint8_t> bytes(10'000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7);
  EXPECT_EQ(store.write_image(1, 0, bytes.data(), 10'000), HalFault::kNone);
  EXPECT_EQ(store.finish_image(1, 10'000), HalFault::kNone);
  std::vector<std::uint8_t> back(10'000);
  EXPECT_EQ(store.read_image(1, 0, back.data(), 10'000), HalFault::kNone);
  EXPECT_EQ(back, bytes);
  EXPECT_EQ(store.read_image(1, 9'000, back.data(), 2'000), HalFault::kNoReading)
      << "beyond what was written";
  EXPECT_EQ(store.read_image(2, 0, back.data(), 10), HalFault::kNoDevice);
  EXPECT_EQ(store.read_given(0, back.data(), 9'000), HalFault::kNone);
  EXPECT_EQ(back[8'999], 0x5a);
  EXPECT_EQ(store.read_given(0, back.data(), 9'001), HalFault::kNoReading);
  stop = true;
  helper.join();
}

TEST(Hatch, StoreWhoseKeeperIsGoneRefuses) {
  const auto hatch = std::make_unique<Hatch>();
  const pid_t child = ended_child();
  hatch->helper = child;
  const std::atomic<bool> stop{false};
  RemoteStore store(*hatch, 1 << 16, stop);
  std::uint8_t byte = 0;
  EXPECT_EQ(store.write_record(0, &byte, 1), HalFault::kRefused);
  ::waitpid(child, nullptr, 0);
}

/// Answers with the request reversed; every second time only later.
struct Echo : CommandHandler {
  std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) override {
    kept.assign(request, request + size);
    if (late) return kLater;
    return later(0, reply);
  }
  std::uint32_t ticket() const override { return 41; }
  std::uint32_t later(std::uint32_t ticket, std::uint8_t* reply) override {
    asked_with = ticket;
    std::copy(kept.rbegin(), kept.rend(), reply);
    return static_cast<std::uint32_t>(kept.size());
  }
  void fill_registers(std::uint16_t* values) override { values[kLiveMode] = 3; }
  CommandGiven give(std::uint16_t command) override {
    return command == 2 ? CommandGiven::kTaken : command == 4 ? CommandGiven::kLater : CommandGiven::kRefused;
  }
  std::vector<std::uint8_t> kept;
  bool late = false;
  std::uint32_t asked_with = 0;
};

TEST(Hatch, LinkBehindItAnswersAsTheHandlerDoes) {
  const auto hatch = std::make_unique<Hatch>();
  hatch->component = ::getpid();
  std::atomic<bool> stop{false};
  Echo echo;
  HatchLink link(hatch->link);
  std::thread component([&] {
    while (!stop) link.serve(echo, TimeUs(5'000));
  });
  HatchHandler handler(*hatch, LinkAccess::kCommand, stop);
  const std::uint8_t request[] = {1, 2, 3};
  std::uint8_t reply[kMaxReplyBytes] = {};
  ASSERT_EQ(handler.answer(request, 3, reply), 3u);
  EXPECT_EQ(reply[0], 3);
  echo.late = true;
  ASSERT_EQ(handler.answer(request, 3, reply), CommandHandler::kLater);
  EXPECT_EQ(handler.ticket(), 41u);
  ASSERT_EQ(handler.later(41, reply), 3u);
  EXPECT_EQ(echo.asked_with, 41u);
  std::uint16_t values[kLiveRegisters] = {};
  handler.fill_registers(values);
  EXPECT_EQ(values[kLiveMode], 3);
  EXPECT_EQ(handler.give(2), CommandGiven::kTaken);
  EXPECT_EQ(handler.give(3), CommandGiven::kRefused);
  EXPECT_EQ(handler.give(4), CommandGiven::kLater);
  EXPECT_EQ(handler.ticket(), 41u);
  stop = true;
  component.join();
}

}  // namespace
}  // namespace vernier::hatch_test
