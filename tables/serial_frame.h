// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "tables/link_format.h"

/// A message of the link on a serial line (UART, 8 bits): the message and its CRC-32C, low byte first,
/// between two END bytes. END and ESC within the message are replaced by two bytes each (SLIP, RFC 1055).
/// After a disturbance the receiver is synchronised again at the next END; a frame with a wrong CRC is
/// ignored.
namespace vernier {

constexpr std::uint8_t kFrameEnd = 0xc0, kFrameEscape = 0xdb, kFrameEscapedEnd = 0xdc,
                       kFrameEscapedEscape = 0xdd;
constexpr std::uint32_t kFrameSumBytes = 4;
constexpr std::uint32_t kMaxFramedBytes = kMaxReplyBytes + kFrameSumBytes;
/// Room for a frame of the longest message on the line.
constexpr std::uint32_t kMaxFrameBytes = 2 * kMaxFramedBytes + 2;

/// Puts a message into a frame. message: size bytes, at most kMaxReplyBytes; frame: room for kMaxFrameBytes.
/// Returns the bytes of the frame. Not real-time safe.
std::uint32_t write_frame(const std::uint8_t* message, std::uint32_t size, std::uint8_t* frame) noexcept;

/// Finds the messages in the bytes of a line.
class FrameReader {
 public:
  /// Takes the next byte; true if the byte completed a message. The message is valid until the next call.
  /// Not real-time safe.
  bool take(std::uint8_t byte) noexcept;
  const std::uint8_t* message() const noexcept { return bytes_; }
  std::uint32_t size() const noexcept { return size_; }

 private:
  std::uint8_t bytes_[kMaxFramedBytes];
  std::uint32_t held_ = 0, size_ = 0;
  bool escaped_ = false, broken_ = false;
};

}  // namespace vernier
