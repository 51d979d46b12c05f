// SPDX-License-Identifier: Apache-2.0
#include "tables/serial_frame.h"

#include "tables/checksum.h"

namespace vernier {

std::uint32_t write_frame(const std::uint8_t* message, std::uint32_t size, std::uint8_t* frame) noexcept {
  std::uint32_t used = 0;
  const auto put = [&](std::uint8_t byte) {
    if (byte == kFrameEnd || byte == kFrameEscape) {
      frame[used++] = kFrameEscape;
      frame[used++] = byte == kFrameEnd ? kFrameEscapedEnd : kFrameEscapedEscape;
    } else {
      frame[used++] = byte;
    }
  };
  frame[used++] = kFrameEnd;
  for (std::uint32_t i = 0; i < size; ++i) put(message[i]);
  const std::uint32_t sum = crc32c(message, size);
  for (unsigned i = 0; i < kFrameSumBytes; ++i) put(static_cast<std::uint8_t>(sum >> (8 * i)));
  frame[used++] = kFrameEnd;
  return used;
}

bool FrameReader::take(std::uint8_t byte) noexcept {
  if (byte == kFrameEnd) {
    const std::uint32_t held = held_;
    const bool whole = !broken_ && !escaped_ && held > kFrameSumBytes;
    held_ = 0;
    escaped_ = broken_ = false;
    if (!whole) return false;
    size_ = held - kFrameSumBytes;
    std::uint32_t sum = 0;
    for (unsigned i = 0; i < kFrameSumBytes; ++i) sum |= std::uint32_t{bytes_[size_ + i]} << (8 * i);
    return sum == crc32c(bytes_, size_);
  }
  if (byte == kFrameEscape && !escaped_) {
    escaped_ = true;
    return false;
  }
  if (escaped_) {
    broken_ = broken_ || (byte != kFrameEscapedEnd && byte != kFrameEscapedEscape);
    byte = byte == kFrameEscapedEnd ? kFrameEnd : kFrameEscape;
    escaped_ = false;
  }
  if (held_ == sizeof(bytes_)) broken_ = true;
  if (!broken_) bytes_[held_++] = byte;
  return false;
}

}  // namespace vernier
