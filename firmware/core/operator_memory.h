// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>

#include "firmware/core/cycle/exchange.h"
#include "firmware/core/cycle/wiring.h"
#include "hal/slot_store.h"
#include "tables/operator_record.h"

namespace vernier {

/// Stores the last settings of the operator and the latched fault on the medium, and restores them at a start
/// of the board. The tick and the links write the present state to Exchange. Only the thread of the store
/// writes the medium.
class OperatorMemory {
 public:
  /// `store`, `wiring`, `exchange`: must exist longer than this object. Not real-time safe.
  OperatorMemory(SlotStore& store, const Wiring& wiring, Exchange& exchange) noexcept
      : store_(store), wiring_(wiring), exchange_(exchange) {}

  /// Reads the stored state and sets the weights of the axes in Exchange. The correction starts deactivated
  /// if a record was begun and is not readable, or if the two records differ by more than one change. The
  /// reason is that the newest setting may have been a deactivation. Call load() once, before the first tick.
  /// Not real-time safe.
  OperatorState load() noexcept;
  /// Writes the present state to the medium if it differs from the stored state, or if a record is damaged.
  /// If the write fails, the next call of save() tries again. Not real-time safe.
  void save() noexcept;
  /// True if the last write failed. A start of the board would then restore an older state, or the correction
  /// would stay deactivated.
  bool refused() const noexcept { return refused_.load(std::memory_order_relaxed); }
  /// stored_ticks() returns the tick of the state that is stored (low 32 bits of Exchange::ticks.count()).
  /// refused_ticks() returns the tick of the newest state whose write failed. Any thread may call these
  /// functions.
  std::uint32_t stored_ticks() const noexcept { return stored_ticks_.load(std::memory_order_acquire); }
  std::uint32_t refused_ticks() const noexcept { return refused_ticks_.load(std::memory_order_acquire); }
  /// Returns the condition of the stored records that load() found.
  StoredPair found() const noexcept { return found_; }
  /// True if load() found damaged records, until an operator activates the correction.
  bool damaged() const noexcept { return damaged_.load(std::memory_order_relaxed); }

 private:
  OperatorState present() const noexcept;
  bool store(const OperatorState& state) noexcept;
  bool store_changes(const OperatorState& now) noexcept;

  SlotStore& store_;
  const Wiring& wiring_;
  Exchange& exchange_;
  OperatorRecords records_;
  OperatorState stored_;
  StoredPair found_ = StoredPair::kNothing;
  int to_write_ = 0;  // number of writes that are still necessary for the newest state
  std::atomic<bool> refused_{false}, damaged_{false};
  std::atomic<std::uint32_t> stored_ticks_{0}, refused_ticks_{0};
};

}  // namespace vernier
