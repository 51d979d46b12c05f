// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "hal/fault.h"

namespace vernier {

/// Memory that keeps its content after a power failure. A slot store has two slots for images, and four small
/// records (0 and 1: SlotRecord; 2 and 3: OperatorRecord). A power failure during a write may leave any
/// mixture of old and new bytes in the range of this write. No other byte changes. A SlotStore is never used
/// in the tick of the firmware.
class SlotStore {
 public:
  virtual ~SlotStore() = default;
  /// Returns the number of bytes that a slot can contain.
  virtual std::uint32_t capacity() const noexcept = 0;
  /// Reads a record. The function read_record() returns kNoReading if the record was never written. A flash
  /// memory may instead return the content of an erased record: all bits are one. The function read_record()
  /// returns kRefused if the record contains fewer bytes than requested, or cannot be read. Not real-time
  /// safe.
  virtual HalFault read_record(std::uint32_t place, std::uint8_t* bytes, std::uint32_t size) noexcept = 0;
  /// True if read_record() may return ones for bytes that were never written, as a flash memory does. If the
  /// function returns false, a record with additional bytes (also ones) was not written by this board. Not
  /// real-time safe.
  virtual bool reads_ones_where_erased() const noexcept { return true; }
  /// Writes a record, and returns after the bytes are on the medium. If the record is a file, there are no
  /// further bytes after the written bytes. If the result is kRefused, the medium may contain a part of the
  /// bytes. Not real-time safe.
  virtual HalFault write_record(std::uint32_t place, const std::uint8_t* bytes,
                                std::uint32_t size) noexcept = 0;
  /// Reads bytes of an image. The function read_image() returns kNoReading for bytes after the end of the
  /// written bytes. Not real-time safe.
  virtual HalFault read_image(std::uint32_t slot, std::uint32_t offset, std::uint8_t* bytes,
                              std::uint32_t size) noexcept = 0;
  /// Writes bytes of an image. The function write_image() returns kNoDevice for bytes beyond the capacity of
  /// the slot, and kRefused if the medium is full or defective. Not real-time safe.
  virtual HalFault write_image(std::uint32_t slot, std::uint32_t offset, const std::uint8_t* bytes,
                               std::uint32_t size) noexcept = 0;
  /// Truncates the slot to `size` bytes, and returns after the bytes are on the medium. Not real-time safe.
  virtual HalFault finish_image(std::uint32_t slot, std::uint32_t size) noexcept = 0;
};

}  // namespace vernier
