// SPDX-License-Identifier: GPL-3.0-or-later
// Axis positions in CAN frames: the layout, and what missing, repeated, late, malformed and stale frames are
// to the firmware. The kernel's own CAN is met on the emulated board; here joined sockets carry the frames.
#include <gtest/gtest.h>

#include <random>

#include "hal/linux/can/can_axes.h"
#include "tests/conformance/linux_devices.h"

namespace vernier::can_axes_test {
namespace {

constexpr std::uint32_t kX = 0x180, kC = 0x1234567;

class Can : public testing::Test {
 protected:
  Can() : axes_(cable_.near(), {kX, kC}) {}
  /// One frame of X with a stamp of its own.
  bool send(std::uint8_t counter, std::int64_t position, bool valid = true) {
    stamp_ = static_cast<std::uint8_t>((stamp_ + 16) % 63);
    return cable_.send(kX, {position, counter, valid, true, stamp_});
  }
  /// Begins a tick and reads X; INT64_MIN: no reading.
  std::int64_t tick() {
    axes_.begin_tick();
    AxisReading reading;
    return axes_.read_axis(0, reading) == HalFault::kNone ? reading.position.count : INT64_MIN;
  }
  static constexpr std::int64_t kNothing = INT64_MIN;
  JoinedSockets cable_;
  CanAxes axes_;
  std::uint8_t stamp_ = 0;
};

TEST(CanAxisFrame, LayoutIsLittleEndianWithTheSignInBit47) {
  std::uint8_t bytes[8];
  encode_axis_frame({-2, 0xab, true, false, 0x21}, bytes);
  const std::uint8_t kWanted[8] = {0xfe, 0xff, 0xff, 0xff, 0xff, 0xff, 0xab, 0x85};
  EXPECT_TRUE(std::equal(bytes, bytes + 8, kWanted));
  const std::uint8_t kOther[8] = {0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x00, 0x02};
  const CanAxisFrame frame = decode_axis_frame(kOther);
  EXPECT_EQ(frame.position, 0x060504030201);
  EXPECT_FALSE(frame.valid);
  EXPECT_TRUE(frame.referenced);
}

TEST(CanAxisFrame, EveryFrameComesBack) {
  std::mt19937_64 random(1);
  RecordProperty("seed", 1);
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t bits = random();
    const std::int64_t position = i == 0   ? CanAxisFrame::kMostPosition
                                  : i == 1 ? -CanAxisFrame::kMostPosition - 1
                                           : static_cast<std::int64_t>(bits) >> 16;
    const CanAxisFrame frame{position, static_cast<std::uint8_t>(bits), (bits & 256) != 0, (bits & 512) != 0,
                             static_cast<std::uint8_t>(bits >> 10 & 63)};
    std::uint8_t bytes[8];
    encode_axis_frame(frame, bytes);
    const CanAxisFrame back = decode_axis_frame(bytes);
    ASSERT_EQ(back.position, frame.position);
    ASSERT_EQ(back.counter, frame.counter);
    ASSERT_EQ(back.valid, frame.valid);
    ASSERT_EQ(back.referenced, frame.referenced);
    ASSERT_EQ(back.stamp, frame.stamp);
  }
}

TEST_F(Can, NewestFrameOfATickCounts) {
  EXPECT_EQ(tick(), kNothing);
  ASSERT_TRUE(send(5, -123'456'789'012));
  EXPECT_EQ(tick(), -123'456'789'012);
  EXPECT_EQ(tick(), kNothing) << "no frame since the last tick";
  ASSERT_TRUE(send(6, 10) && send(7, 20));
  EXPECT_EQ(tick(), 20);
  EXPECT_EQ(axes_.counts().frames, 3u);
  EXPECT_EQ(axes_.counts().lost, 0u);
}

TEST_F(Can, LongIdentifierIsAnAxisOfItsOwn) {
  ASSERT_TRUE(cable_.send(kC | CAN_EFF_FLAG, {77, 0, true, false, 1}));
  EXPECT_EQ(tick(), kNothing);
  AxisReading reading;
  ASSERT_EQ(axes_.read_axis(1, reading), HalFault::kNone);
  EXPECT_EQ(reading.position, AxisPosition(77));
  EXPECT_FALSE(reading.referenced);
  PathReading path;
  path.feed = FeedNmPerMin(3);
  EXPECT_EQ(axes_.read_path(path), HalFault::kNone);
  EXPECT_EQ(path.feed, FeedNmPerMin(0));
}

TEST_F(Can, CounterRollsOverAndTellsWhatWasLost) {
  for (int i = 250; i < 260; ++i) {
    ASSERT_TRUE(send(static_cast<std::uint8_t>(i), i));
    ASSERT_EQ(tick(), i);
  }
  EXPECT_EQ(axes_.counts().lost, 0u);
  ASSERT_TRUE(send(7, 1));
  EXPECT_EQ(tick(), 1);
  EXPECT_EQ(axes_.counts().lost, 3u);
}

TEST_F(Can, RepeatedAndLateFramesAreNotTaken) {
  ASSERT_TRUE(send(10, 100));
  EXPECT_EQ(tick(), 100);
  ASSERT_TRUE(send(10, 111));
  EXPECT_EQ(tick(), kNothing);
  ASSERT_TRUE(send(9, 99) && send(8, 98));
  EXPECT_EQ(tick(), kNothing);
  ASSERT_TRUE(send(11, 101) && send(10, 100));
  EXPECT_EQ(tick(), 101);
  EXPECT_EQ(axes_.counts().duplicates, 1u);
  EXPECT_EQ(axes_.counts().late, 3u);
  EXPECT_EQ(axes_.counts().restarts, 0u);
}

TEST_F(Can, ControllerThatStartsAgainIsBelievedAfterFourFrames) {
  ASSERT_TRUE(send(100, 1));
  EXPECT_EQ(tick(), 1);
  for (std::uint8_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(send(i, 50 + i));
    EXPECT_EQ(tick(), kNothing);
  }
  ASSERT_TRUE(send(3, 53));
  EXPECT_EQ(tick(), 53);
  ASSERT_TRUE(send(4, 54));
  EXPECT_EQ(tick(), 54);
  EXPECT_EQ(axes_.counts().restarts, 1u);
}

TEST_F(Can, InvalidFrameTakesBackTheOneBefore) {
  ASSERT_TRUE(send(1, 10) && send(2, 20, false));
  EXPECT_EQ(tick(), kNothing);
  EXPECT_EQ(axes_.counts().invalid, 1u);
}

TEST_F(Can, MeasuringThatStandsStillIsNoReading) {
  for (std::uint8_t i = 0; i < 6; ++i) {
    ASSERT_TRUE(cable_.send(kX, {1000, i, true, true, 42}));
    EXPECT_EQ(tick(), i < CanAxes::kStalledFrames ? 1000 : kNothing) << int{i};
  }
  EXPECT_EQ(axes_.counts().stalled, 3u);
  ASSERT_TRUE(cable_.send(kX, {1001, 6, true, true, 43}));
  EXPECT_EQ(tick(), 1001);
}

TEST_F(Can, MalformedFramesAreCountedAndLeftOut) {
  can_frame frame{};
  frame.can_id = kX, frame.can_dlc = 7;
  ASSERT_TRUE(cable_.send(frame));
  frame.can_dlc = 8, frame.can_id = kX | CAN_RTR_FLAG;
  ASSERT_TRUE(cable_.send(frame));
  frame.can_id = 0x181;
  ASSERT_TRUE(cable_.send(frame));
  frame.can_id = CAN_ERR_FLAG | 0x40;
  ASSERT_TRUE(cable_.send(frame));
  EXPECT_EQ(tick(), kNothing);
  EXPECT_EQ(axes_.counts().malformed, 3u);
  EXPECT_EQ(axes_.counts().bus_errors, 1u);
}

TEST_F(Can, FloodIsTakenInPortions) {
  // The kernel bounds what a datagram socket holds; what fits is more than the axes need in a tick.
  int sent = 0;
  while (sent < 1000 && send(static_cast<std::uint8_t>(sent), sent)) ++sent;
  ASSERT_GT(sent, 1);
  const int first = std::min<int>(sent, CanAxes::kMostFrames);
  EXPECT_EQ(tick(), first - 1);
}

TEST(CanAxes, RefusesWhatCannotBe) {
  std::string error;
  EXPECT_EQ(CanAxes::open("can0", {}, error), nullptr);
  EXPECT_EQ(CanAxes::open("can0", {1, 1}, error), nullptr);
  EXPECT_NE(error.find("identifiers"), std::string::npos) << error;
  EXPECT_EQ(CanAxes::open("can0", {1u << 29}, error), nullptr);
  EXPECT_EQ(CanAxes::open("nocan", {1, 2}, error), nullptr);
  // Without CAN in the kernel that is said instead.
  EXPECT_TRUE(error.find("no such interface") != std::string::npos ||
              error.find("this kernel does not support CAN") != std::string::npos)
      << error;
}

}  // namespace
}  // namespace vernier::can_axes_test
