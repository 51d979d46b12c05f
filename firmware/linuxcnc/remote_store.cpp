// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/remote_store.h"

#include <algorithm>

namespace vernier {

HalFault RemoteStore::call(StoreOp op, std::uint32_t place, std::uint32_t offset,
                           std::uint32_t size) noexcept {
  Call& store = hatch_.store;
  store.op = static_cast<std::uint32_t>(op);
  store.place = place, store.offset = offset, store.size = size;
  if (!make_call(store, hatch_.helper.load(), stop_)) return HalFault::kRefused;
  return store.result >= 0 && store.result <= static_cast<int>(HalFault::kRefused)
             ? static_cast<HalFault>(store.result)
             : HalFault::kRefused;
}

HalFault RemoteStore::read(StoreOp op, std::uint32_t place, std::uint32_t offset, std::uint8_t* bytes,
                           std::uint32_t size) noexcept {
  for (std::uint32_t done = 0; done < size;) {
    const std::uint32_t piece = std::min(size - done, Call::kMostBytes);
    if (const HalFault fault = call(op, place, offset + done, piece); fault != HalFault::kNone) return fault;
    std::copy_n(hatch_.store.bytes, piece, bytes + done);
    done += piece;
  }
  return HalFault::kNone;
}

HalFault RemoteStore::write(StoreOp op, std::uint32_t place, std::uint32_t offset, const std::uint8_t* bytes,
                            std::uint32_t size) noexcept {
  for (std::uint32_t done = 0; done < size;) {
    const std::uint32_t piece = std::min(size - done, Call::kMostBytes);
    std::copy_n(bytes + done, piece, hatch_.store.bytes);
    if (const HalFault fault = call(op, place, offset + done, piece); fault != HalFault::kNone) return fault;
    done += piece;
  }
  return HalFault::kNone;
}

// A record is one piece: it is written as a whole or not at all.
HalFault RemoteStore::read_record(std::uint32_t place, std::uint8_t* bytes, std::uint32_t size) noexcept {
  return read(StoreOp::kReadRecord, place, 0, bytes, size);
}
HalFault RemoteStore::write_record(std::uint32_t place, const std::uint8_t* bytes,
                                   std::uint32_t size) noexcept {
  return write(StoreOp::kWriteRecord, place, 0, bytes, size);
}
HalFault RemoteStore::read_image(std::uint32_t slot, std::uint32_t offset, std::uint8_t* bytes,
                                 std::uint32_t size) noexcept {
  return read(StoreOp::kReadImage, slot, offset, bytes, size);
}
HalFault RemoteStore::write_image(std::uint32_t slot, std::uint32_t offset, const std::uint8_t* bytes,
                                  std::uint32_t size) noexcept {
  return write(StoreOp::kWriteImage, slot, offset, bytes, size);
}
HalFault RemoteStore::finish_image(std::uint32_t slot, std::uint32_t size) noexcept {
  return call(StoreOp::kFinishImage, slot, 0, size);
}
HalFault RemoteStore::read_given(std::uint32_t offset, std::uint8_t* bytes, std::uint32_t size) noexcept {
  return read(StoreOp::kReadGiven, 0, offset, bytes, size);
}

}  // namespace vernier
