// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/operator_memory.h"

#include <cstring>

namespace vernier {
namespace {

std::uint32_t number_of(const Wiring::Axis& axis) noexcept {
  return operator_axis(axis.name.c_str(), static_cast<std::uint32_t>(axis.name.size()));
}

}  // namespace

OperatorRecord OperatorMemory::read(std::uint32_t place) noexcept {
  OperatorRecord record{};
  std::uint8_t bytes[sizeof(OperatorRecord)];
  if (store_.read_record(place, bytes, sizeof(bytes)) == HalFault::kNone)
    std::memcpy(&record, bytes, sizeof(record));
  return record;
}

// Erased flash reads as ones.
bool OperatorMemory::is_written(std::uint32_t place) noexcept {
  std::uint8_t bytes[sizeof(OperatorRecord)];
  const HalFault first = store_.read_record(place, bytes, 1);
  // A store of an earlier version has no such place.
  if (first == HalFault::kNoReading || first == HalFault::kNoDevice) return false;
  if (store_.read_record(place, bytes, sizeof(bytes)) != HalFault::kNone) return true;
  for (const std::uint8_t byte : bytes)
    if (byte != 0xff) return true;
  return false;
}

OperatorState OperatorMemory::present() const noexcept {
  const std::uint32_t said = exchange_.operator_said.load(std::memory_order_acquire);
  OperatorState state;
  state.out = static_cast<std::uint8_t>(said & 1);
  state.holding = static_cast<std::uint8_t>(said >> 8 & 1);
  state.fault = static_cast<std::uint8_t>(said >> 16);
  for (std::size_t i = 0; i < wiring_.axes.size(); ++i) {
    state.axis[i] = number_of(wiring_.axes[i]);
    state.weight[i] = exchange_.axis_weight[i].load(std::memory_order_relaxed);
  }
  return state;
}

OperatorState OperatorMemory::load() noexcept {
  const OperatorRecord first = read(kOperatorPlace), second = read(kOperatorPlace + 1);
  records_ = OperatorRecords::load(first, second);
  // A power failure may have cut the first record that was ever written: nothing was set by then.
  lost_ = !records_.known() && is_written(kOperatorPlace) && is_written(kOperatorPlace + 1);
  stored_ = records_.known() ? records_.state() : present();
  OperatorState state = stored_;
  if (lost_) state.out = 1;
  for (std::size_t i = 0; records_.known() && i < wiring_.axes.size(); ++i)
    for (std::size_t k = 0; k < kMaxAxes; ++k)
      if (state.axis[k] == number_of(wiring_.axes[i]) && state.weight[k] >= 0 &&
          state.weight[k] <= kFullWeight.count)
        exchange_.axis_weight[i].store(state.weight[k]);
  return state;
}

void OperatorMemory::save() noexcept {
  const OperatorState now = present();
  if (now == stored_) return;
  const OperatorChange change = records_.change_to(now);
  std::uint8_t bytes[sizeof(OperatorRecord)];
  std::memcpy(bytes, &change.record, sizeof(bytes));
  const bool written = store_.write_record(change.place, bytes, sizeof(bytes)) == HalFault::kNone;
  refused_.store(!written, std::memory_order_relaxed);
  if (!written) return;
  records_.stored(change);
  stored_ = now;
}

}  // namespace vernier
