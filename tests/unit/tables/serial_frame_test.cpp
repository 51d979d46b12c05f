// SPDX-License-Identifier: GPL-3.0-or-later
#include "tables/serial_frame.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>
#include <vector>

namespace vernier {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes framed(const Bytes& message) {
  Bytes frame(kMaxFrameBytes);
  frame.resize(write_frame(message.data(), static_cast<std::uint32_t>(message.size()), frame.data()));
  return frame;
}

std::vector<Bytes> messages_in(FrameReader& reader, const Bytes& line) {
  std::vector<Bytes> found;
  for (const std::uint8_t byte : line)
    if (reader.take(byte)) found.emplace_back(reader.message(), reader.message() + reader.size());
  return found;
}

// The sum by a second implementation, outside this house.
TEST(SerialFrame, EscapesAndEndsAsDeclared) {
  const Bytes frame = framed({0x01, 0xc0, 0xdb});
  ASSERT_GE(frame.size(), 11u);
  EXPECT_EQ(Bytes(frame.begin(), frame.begin() + 6), (Bytes{0xc0, 0x01, 0xdb, 0xdc, 0xdb, 0xdd}));
  EXPECT_EQ(frame.back(), 0xc0);
  EXPECT_EQ(framed({0x01, 0x01}), (Bytes{0xc0, 0x01, 0x01, 0xa6, 0x6c, 0xa8, 0x10, 0xc0}));
}

TEST(SerialFrame, LongestMessageOfEscapesComesThrough) {
  for (const std::uint8_t value : {std::uint8_t{0xc0}, std::uint8_t{0xdb}}) {
    const Bytes longest(kMaxReplyBytes, value);
    FrameReader reader;
    EXPECT_EQ(messages_in(reader, framed(longest)), std::vector<Bytes>{longest});
  }
}

// The sum of the frame is that of the message with the escape byte: only the unknown escape refuses it.
TEST(SerialFrame, FrameWithAnUnknownEscapeIsNoMessage) {
  const Bytes message = {0x01, kFrameEscape, 0x02};
  Bytes frame = framed(message);
  ASSERT_EQ(frame[3], kFrameEscapedEscape);
  FrameReader reader;
  EXPECT_EQ(messages_in(reader, frame), std::vector<Bytes>{message});
  frame[3] = 0x55;
  EXPECT_TRUE(messages_in(reader, frame).empty());
  EXPECT_EQ(messages_in(reader, framed(message)), std::vector<Bytes>{message}) << "the next frame";
}

TEST(SerialFrame, TooLongAMessageIsNoneAndTheNextOneIs) {
  FrameReader reader;
  Bytes line(5000, 0x55);
  line.front() = line.back() = kFrameEnd;
  EXPECT_TRUE(messages_in(reader, line).empty());
  EXPECT_EQ(messages_in(reader, framed({1, 2})), (std::vector<Bytes>{{1, 2}}));
}

// Noise between, and a byte lost, changed or doubled inside: the frame is lost, never read as another one,
// and the next one is read.
TEST(SerialFrame, DisturbedLineIsInStepAgainWithTheNextFrame) {
  constexpr unsigned kSeed = 1055;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  FrameReader reader;
  int lost = 0;
  for (int i = 0; i < 20000; ++i) {
    Bytes message(1 + random() % 40);
    for (std::uint8_t& byte : message)
      byte = random() % 3 == 0 ? std::uint8_t{0xc0} : static_cast<std::uint8_t>(random());
    Bytes bad = framed(message);
    const auto at = bad.begin() + static_cast<std::ptrdiff_t>(random() % bad.size());
    switch (random() % 3) {
      case 0:
        bad.erase(at);
        break;
      case 1:
        *at = static_cast<std::uint8_t>(*at ^ (1u << random() % 8));
        break;
      default:
        bad.insert(at, *at);
    }
    for (const Bytes& found : messages_in(reader, bad)) ASSERT_EQ(found, message);
    const Bytes last = {7, static_cast<std::uint8_t>(i)};
    // Its first END closes what the disturbed frame left open.
    const auto found = messages_in(reader, framed(last));
    ASSERT_FALSE(found.empty());
    ASSERT_EQ(found.back(), last);
    ++lost;
  }
  EXPECT_EQ(lost, 20000);
}

}  // namespace
}  // namespace vernier
