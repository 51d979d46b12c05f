// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/operator_memory.h"

#include <cstring>

#include "firmware/core/link/read_place.h"
#include "tables/link_format.h"

namespace vernier {
namespace {

std::uint32_t number_of(const Wiring::Axis& axis) noexcept {
  return operator_axis(axis.name.c_str(), static_cast<std::uint32_t>(axis.name.size()));
}

}  // namespace

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
  records_ = OperatorRecords::load(read_place<OperatorRecord>(store_, kOperatorPlace),
                                   read_place<OperatorRecord>(store_, kOperatorPlace + 1));
  found_ = records_.places();
  damaged_.store(found_ == StoredPair::kDamaged, std::memory_order_relaxed);
  stored_ = records_.known() ? records_.state() : present();
  to_write_ = records_.once() ? 2 : 0;
  OperatorState state = stored_;
  if (damaged()) state.out = 1;
  for (std::size_t i = 0; records_.known() && i < wiring_.axes.size(); ++i)
    for (std::size_t k = 0; k < kMaxAxes; ++k)
      if (state.axis[k] == number_of(wiring_.axes[i]) && state.weight[k] >= 0 &&
          state.weight[k] <= kFullWeight.count)
        exchange_.axis_weight[i].store(state.weight[k]);
  return state;
}

bool OperatorMemory::store(const OperatorState& state) noexcept {
  const OperatorChange change = records_.change_to(state);
  std::uint8_t bytes[sizeof(OperatorRecord)];
  std::memcpy(bytes, &change.record, sizeof(bytes));
  const bool written = store_.write_record(change.place, bytes, sizeof(bytes)) == HalFault::kNone;
  refused_.store(!written, std::memory_order_relaxed);
  if (!written) return false;
  records_.stored(change);
  stored_ = state;
  return true;
}

// Every setting is written to both places: a record that is lost or unreadable shows, and one that is an
// older copy is not the newest, or no neighbour of the other. A state that a start found in one place only is
// written to both again.
bool OperatorMemory::store_changes(const OperatorState& now) noexcept {
  if (now != stored_) {
    if (!store(now)) return false;
    to_write_ = 1;
  }
  if (records_.places() == StoredPair::kDamaged) to_write_ = 2;
  for (; to_write_ > 0; --to_write_)
    if (!store(now)) return false;
  return true;
}

void OperatorMemory::save() noexcept {
  // The state is at least as new as the ticks.
  const auto ticks = static_cast<std::uint32_t>(exchange_.ticks.count());
  const OperatorState now = present();
  if (damaged() && now.out == 0) damaged_.store(false, std::memory_order_relaxed);
  const bool stored = store_changes(now);
  if (stored)
    refused_.store(false, std::memory_order_relaxed), stored_ticks_.store(ticks, std::memory_order_release);
  else
    refused_ticks_.store(ticks, std::memory_order_release);
  std::uint32_t flags = 0;
  if (damaged()) flags |= kSettingDamaged;
  if (!stored) flags |= kSettingRefused;
  exchange_.setting_flags.store(flags, std::memory_order_relaxed);
}

}  // namespace vernier
