// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "hal/fault.h"

namespace vernier {

/// Memory that survives a power failure: two slots for images, and four small records (0 and 1: SlotRecord; 2
/// and 3: OperatorRecord). A power failure during a write may leave any mixture of old and new bytes in the
/// range of this write; no other byte changes. A SlotStore is never used in the tick.
class SlotStore {
 public:
  virtual ~SlotStore() = default;
  /// Returns the number of bytes that a slot can contain.
  virtual std::uint32_t capacity() const noexcept = 0;
  /// kNoReading: the slot was never written. A flash may instead return the contents of an erased slot, all
  /// bits one. kRefused: the slot contains fewer bytes than requested, or cannot be read. Not real-time safe.
  virtual HalFault read_record(std::uint32_t place, std::uint8_t* bytes, std::uint32_t size) noexcept = 0;
  /// True if read_record() may give ones for bytes that were never written, as a flash does. False: a record
  /// whose place has further bytes, also ones, is none of this board. Not real-time safe.
  virtual bool reads_ones_where_erased() const noexcept { return true; }
  /// Returns when the bytes are on the medium. A place that is a file has no bytes behind them. kRefused: the
  /// medium may have a part of the bytes. Not real-time safe.
  virtual HalFault write_record(std::uint32_t place, const std::uint8_t* bytes,
                                std::uint32_t size) noexcept = 0;
  /// kNoReading: beyond the written bytes. Not real-time safe.
  virtual HalFault read_image(std::uint32_t slot, std::uint32_t offset, std::uint8_t* bytes,
                              std::uint32_t size) noexcept = 0;
  /// kNoDevice: beyond the capacity; kRefused: the medium is full or broken. Not real-time safe.
  virtual HalFault write_image(std::uint32_t slot, std::uint32_t offset, const std::uint8_t* bytes,
                               std::uint32_t size) noexcept = 0;
  /// Cuts the slot to `size` bytes and returns when the bytes are on the medium. Not real-time safe.
  virtual HalFault finish_image(std::uint32_t slot, std::uint32_t size) noexcept = 0;
};

}  // namespace vernier
