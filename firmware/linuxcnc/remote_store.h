// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "firmware/linuxcnc/hatch.h"
#include "hal/slot_store.h"

namespace vernier {

/// Access of the component to the store, which the process vernier-hal manages. After the end of vernier-hal,
/// every access fails as with a broken medium. The running image continues.
class RemoteStore : public SlotStore {
 public:
  /// `hatch`, `stop`: must exist longer than the store. Not real-time safe.
  RemoteStore(Hatch& hatch, std::uint32_t capacity, const std::atomic<bool>& stop) noexcept
      : hatch_(hatch), stop_(stop), capacity_(capacity) {}

  std::uint32_t capacity() const noexcept override { return capacity_; }
  bool reads_ones_where_erased() const noexcept override { return false; }
  HalFault read_record(std::uint32_t place, std::uint8_t* bytes, std::uint32_t size) noexcept override;
  HalFault write_record(std::uint32_t place, const std::uint8_t* bytes, std::uint32_t size) noexcept override;
  HalFault read_image(std::uint32_t slot, std::uint32_t offset, std::uint8_t* bytes,
                      std::uint32_t size) noexcept override;
  HalFault write_image(std::uint32_t slot, std::uint32_t offset, const std::uint8_t* bytes,
                       std::uint32_t size) noexcept override;
  HalFault finish_image(std::uint32_t slot, std::uint32_t size) noexcept override;
  /// Reads bytes of the image that was given to vernier-hal at its start. Not real-time safe.
  HalFault read_given(std::uint32_t offset, std::uint8_t* bytes, std::uint32_t size) noexcept;

 private:
  HalFault call(StoreOp op, std::uint32_t place, std::uint32_t offset, std::uint32_t size) noexcept;
  HalFault read(StoreOp op, std::uint32_t place, std::uint32_t offset, std::uint8_t* bytes,
                std::uint32_t size) noexcept;
  HalFault write(StoreOp op, std::uint32_t place, std::uint32_t offset, const std::uint8_t* bytes,
                 std::uint32_t size) noexcept;

  Hatch& hatch_;
  const std::atomic<bool>& stop_;
  std::uint32_t capacity_;
};

}  // namespace vernier
