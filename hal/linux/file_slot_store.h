// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "hal/slot_store.h"

namespace vernier {

/// Slots and records as files of a directory: slot0.vup, slot1.vup, record0 to record3. Every completed write
/// is on the medium.
class FileSlotStore : public SlotStore {
 public:
  /// `directory`: an existing directory in which files can be written; `capacity`: largest number of bytes in
  /// a slot. Not real-time safe.
  FileSlotStore(std::string directory, std::uint32_t capacity);

  std::uint32_t capacity() const noexcept override { return capacity_; }
  bool reads_ones_where_erased() const noexcept override { return false; }
  HalFault read_record(std::uint32_t place, std::uint8_t* bytes, std::uint32_t size) noexcept override;
  /// If a record has no file, creates a file of `size` bytes with all bits one (never written). The first
  /// write of such a record needs no additional space on the medium. Not real-time safe.
  HalFault reserve_record(std::uint32_t place, std::uint32_t size) noexcept;
  HalFault write_record(std::uint32_t place, const std::uint8_t* bytes, std::uint32_t size) noexcept override;
  HalFault read_image(std::uint32_t slot, std::uint32_t offset, std::uint8_t* bytes,
                      std::uint32_t size) noexcept override;
  HalFault write_image(std::uint32_t slot, std::uint32_t offset, const std::uint8_t* bytes,
                       std::uint32_t size) noexcept override;
  HalFault finish_image(std::uint32_t slot, std::uint32_t size) noexcept override;

 private:
  std::string directory_;
  std::string records_[4], slots_[2];
  std::uint32_t capacity_;
};

}  // namespace vernier
