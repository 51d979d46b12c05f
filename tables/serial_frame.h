// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "tables/link_format.h"

/// Frame for a message of the link on a serial line (UART, 8 bits). A frame contains the message and its
/// CRC-32C, low byte first, between two END bytes. In the frame, two bytes replace each END or ESC byte of
/// the message (SLIP, RFC 1055). After a disturbance, the receiver is synchronised again at the next END
/// byte. A frame with a wrong CRC is ignored.
namespace vernier {

constexpr std::uint8_t kFrameEnd = 0xc0, kFrameEscape = 0xdb, kFrameEscapedEnd = 0xdc,
                       kFrameEscapedEscape = 0xdd;
constexpr std::uint32_t kFrameSumBytes = 4;
constexpr std::uint32_t kMaxFramedBytes = kMaxReplyBytes + kFrameSumBytes;
/// Largest number of bytes in a frame, for the longest message.
constexpr std::uint32_t kMaxFrameBytes = 2 * kMaxFramedBytes + 2;

/// Converts a message to a frame. `message`: `size` bytes, at most kMaxReplyBytes; `frame`: memory for
/// kMaxFrameBytes bytes. Returns the number of bytes in the frame. Not real-time safe.
std::uint32_t write_frame(const std::uint8_t* message, std::uint32_t size, std::uint8_t* frame) noexcept;

/// Finds the messages in the bytes that are received from a serial line.
class FrameReader {
 public:
  /// Takes the next byte. Returns true if a message is complete with this byte. The result of
  /// message() is valid until the next call of take(). Not real-time safe.
  bool take(std::uint8_t byte) noexcept;
  const std::uint8_t* message() const noexcept { return bytes_; }
  std::uint32_t size() const noexcept { return size_; }

 private:
  std::uint8_t bytes_[kMaxFramedBytes];
  std::uint32_t held_ = 0, size_ = 0;
  bool escaped_ = false, broken_ = false;
};

}  // namespace vernier
