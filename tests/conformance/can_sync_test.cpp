// SPDX-License-Identifier: GPL-3.0-or-later
// The sync of a bus on joined sockets: waits until it comes or the time is over, and takes several as one.
#include "hal/linux/can/can_sync.h"

#include <gtest/gtest.h>

#include <thread>

#include "hal/linux/monotonic_clock.h"
#include "tests/conformance/linux_devices.h"

namespace vernier::can_sync_test {
namespace {

class Sync : public testing::Test {
 protected:
  InstantNs in(std::int64_t ms) { return clock_.now() + InstantNs(ms * 1'000'000); }
  bool send() {
    can_frame frame{};
    frame.can_id = 0x80;
    return bus_.send(frame);
  }
  MonotonicClock clock_;
  JoinedSockets bus_;
  CanSync sync_{bus_.near()};
};

TEST_F(Sync, ComesOrTheTimeIsOver) {
  const InstantNs latest = in(20);
  EXPECT_EQ(sync_.wait_for_sync(latest), HalFault::kNoReading);
  EXPECT_GE(clock_.now(), latest);
  ASSERT_TRUE(send());
  EXPECT_EQ(sync_.wait_for_sync(in(5000)), HalFault::kNone);
  EXPECT_EQ(sync_.wait_for_sync(in(1)), HalFault::kNoReading) << "it is used up";
}

TEST_F(Sync, IsWaitedFor) {
  std::thread later([&] {
    clock_.sleep_until(in(30));
    EXPECT_TRUE(send());
  });
  EXPECT_EQ(sync_.wait_for_sync(in(60'000)), HalFault::kNone);
  later.join();
}

TEST_F(Sync, SeveralAreOneAndOldOnesDoNotQueueUp) {
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(send());
  EXPECT_EQ(sync_.wait_for_sync(in(0)), HalFault::kNone);
  EXPECT_EQ(sync_.wait_for_sync(in(0)), HalFault::kNoReading);
}

TEST(SyncSetUp, MissingBusIsNamed) {
  std::string error;
  EXPECT_EQ(CanSync::open("nocan", 0x80, error), nullptr);
  EXPECT_TRUE(error.find("nocan: no such interface") != std::string::npos ||
              error.find("nocan: this kernel does not support CAN") != std::string::npos)
      << error;
}

}  // namespace
}  // namespace vernier::can_sync_test
