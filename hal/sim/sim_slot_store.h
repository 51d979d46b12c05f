// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "hal/slot_store.h"

namespace vernier {

/// A slot store in memory for tests. The power of this store can fail at any byte of any write. After the
/// simulated power failure, the bytes written before it are new and the other bytes are old. After
/// the simulated power failure, no byte is written until restore_power() is called. A SimSlotStore
/// can also be full, or fail to write.
class SimSlotStore : public SlotStore {
 public:
  explicit SimSlotStore(std::uint32_t capacity) : capacity_(capacity) {}

  /// Simulates a power failure after `bytes` more bytes have been written.
  void cut_power_after(std::uint64_t bytes) {
    left_ = bytes;
    limited_ = true;
  }
  void restore_power() { limited_ = dead_ = false; }
  bool dead() const { return dead_; }
  /// Returns the number of bytes that were written since the start.
  std::uint64_t written() const { return written_; }
  /// Truncates a record to its first `size` bytes; with 0 bytes the record counts as never written.
  void cut_record(std::uint32_t place, std::uint32_t size) { records_[place].resize(size); }
  /// Limits the space of the medium: no more than `bytes` image bytes can be written.
  void fill_up_to(std::uint32_t bytes) { room_ = bytes; }

  std::uint32_t capacity() const noexcept override { return capacity_; }
  bool reads_ones_where_erased() const noexcept override { return false; }
  HalFault read_record(std::uint32_t place, std::uint8_t* bytes, std::uint32_t size) noexcept override {
    return place < 4 ? read(records_[place], 0, bytes, size) : HalFault::kNoDevice;
  }
  HalFault write_record(std::uint32_t place, const std::uint8_t* bytes,
                        std::uint32_t size) noexcept override {
    if (place >= 4) return HalFault::kNoDevice;
    const HalFault fault = write(records_[place], 0, bytes, size);
    if (fault == HalFault::kNone) records_[place].resize(size);
    return fault;
  }
  HalFault read_image(std::uint32_t slot, std::uint32_t offset, std::uint8_t* bytes,
                      std::uint32_t size) noexcept override {
    return slot < 2 ? read(slots_[slot], offset, bytes, size) : HalFault::kNoDevice;
  }
  HalFault write_image(std::uint32_t slot, std::uint32_t offset, const std::uint8_t* bytes,
                       std::uint32_t size) noexcept override {
    if (slot >= 2 || offset > capacity_ || size > capacity_ - offset) return HalFault::kNoDevice;
    if (offset + size > room_) return HalFault::kRefused;
    return write(slots_[slot], offset, bytes, size);
  }
  HalFault finish_image(std::uint32_t slot, std::uint32_t size) noexcept override {
    if (slot >= 2 || slots_[slot].size() < size) return HalFault::kNoDevice;
    if (!spend_one()) return HalFault::kRefused;
    slots_[slot].resize(size);
    return HalFault::kNone;
  }

 private:
  bool spend_one() noexcept {
    if (dead_) return false;
    if (limited_ && left_ == 0) return dead_ = true, false;
    left_ -= limited_ ? 1 : 0;
    ++written_;
    return true;
  }
  HalFault read(const std::vector<std::uint8_t>& from, std::uint32_t offset, std::uint8_t* bytes,
                std::uint32_t size) const noexcept {
    if (dead_) return HalFault::kRefused;
    if (offset > from.size() || size > from.size() - offset) return HalFault::kNoReading;
    std::copy_n(from.data() + offset, size, bytes);
    return HalFault::kNone;
  }
  HalFault write(std::vector<std::uint8_t>& to, std::uint32_t offset, const std::uint8_t* bytes,
                 std::uint32_t size) noexcept {
    if (to.size() < std::size_t{offset} + size) to.resize(std::size_t{offset} + size, 0xff);
    for (std::uint32_t i = 0; i < size; ++i) {
      if (!spend_one()) return HalFault::kRefused;
      to[offset + i] = bytes[i];
    }
    return HalFault::kNone;
  }

  std::uint32_t capacity_;
  std::uint32_t room_ = UINT32_MAX;
  std::vector<std::uint8_t> records_[4], slots_[2];
  std::uint64_t left_ = 0, written_ = 0;
  bool limited_ = false, dead_ = false;
};

}  // namespace vernier
