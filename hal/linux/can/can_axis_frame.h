// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// State of one axis in one CAN frame of 8 data bytes. The frame is a classic CAN frame, with a separate
/// identifier for each axis:
///
///   bytes 0..5  position, signed, 48 bits, least significant byte first; counts of the axis: 1 nm
///               (±140 km), or 2^-32 turn (±32768 turns)
///   byte 6      counter: increases by 1 with each frame of this axis, modulo 256
///   byte 7      bit 0 the position is valid, bit 1 the axis is referenced, bits 2..7 stamp
///
/// The stamp is the low six bits of the controller's clock, in units of 64 us, at the time when the position
/// was *sampled*. If the measurement of a controller has stopped while its communication continues, the stamp
/// does not change.
struct CanAxisFrame {
  static constexpr unsigned kBytes = 8;
  static constexpr std::int64_t kMostPosition = (std::int64_t{1} << 47) - 1;

  std::int64_t position = 0;  // -2^47 to 2^47 - 1
  std::uint8_t counter = 0;
  bool valid = false, referenced = false;
  std::uint8_t stamp = 0;  // 0..63
};

constexpr CanAxisFrame decode_axis_frame(const std::uint8_t (&bytes)[CanAxisFrame::kBytes]) noexcept {
  std::uint64_t position = 0;
  for (unsigned i = 0; i < 6; ++i) position |= std::uint64_t{bytes[i]} << (8 * i + 16);
  const std::uint8_t flags = bytes[7];
  // The sign of the position is in the highest bit; the shift to the right extends this sign.
  return {static_cast<std::int64_t>(position) >> 16, bytes[6], (flags & 1) != 0, (flags & 2) != 0,
          static_cast<std::uint8_t>(flags >> 2)};
}

constexpr void encode_axis_frame(const CanAxisFrame& frame,
                                 std::uint8_t (&bytes)[CanAxisFrame::kBytes]) noexcept {
  for (unsigned i = 0; i < 6; ++i)
    bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(frame.position) >> (8 * i));
  bytes[6] = frame.counter;
  bytes[7] =
      static_cast<std::uint8_t>((frame.valid ? 1 : 0) | (frame.referenced ? 2 : 0) | (frame.stamp & 63) << 2);
}

}  // namespace vernier
