// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/store_server.h"

#include <algorithm>

#include "tables/operator_record.h"
#include "tables/slots.h"

namespace vernier {

HalFault StoreServer::read_given() noexcept {
  if (std::uint64_t{call_.offset} + call_.size > given_.size()) return HalFault::kNoReading;
  std::copy_n(given_.data() + call_.offset, call_.size, call_.bytes);
  return HalFault::kNone;
}

HalFault StoreServer::run() noexcept {
  const auto op = static_cast<StoreOp>(call_.op);
  if (op == StoreOp::kFinishImage)
    return call_.place < kSlotCount ? store_.finish_image(call_.place, call_.size) : HalFault::kNoDevice;
  if (call_.size > Call::kMostBytes) return HalFault::kRefused;
  if (op == StoreOp::kReadGiven) return read_given();
  const bool record = op == StoreOp::kReadRecord || op == StoreOp::kWriteRecord;
  if (call_.place >= (record ? kSlotRecordCount + kOperatorRecordCount : kSlotCount))
    return HalFault::kNoDevice;
  switch (op) {
    case StoreOp::kReadRecord:
      return store_.read_record(call_.place, call_.bytes, call_.size);
    case StoreOp::kWriteRecord:
      return store_.write_record(call_.place, call_.bytes, call_.size);
    case StoreOp::kReadImage:
      return store_.read_image(call_.place, call_.offset, call_.bytes, call_.size);
    case StoreOp::kWriteImage:
      return store_.write_image(call_.place, call_.offset, call_.bytes, call_.size);
    default:
      return HalFault::kRefused;
  }
}

void StoreServer::serve(TimeUs wait) noexcept {
  if (!wait_for_call(call_, wait)) return;
  call_.result = static_cast<std::int32_t>(run());
  answer_call(call_);
}

}  // namespace vernier
