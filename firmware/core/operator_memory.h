// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>

#include "firmware/core/cycle/exchange.h"
#include "firmware/core/cycle/wiring.h"
#include "hal/slot_store.h"
#include "tables/operator_record.h"

namespace vernier {

/// Stores the last settings of the operator and the latched fault, and restores them at a start. The tick
/// and the links put the present state into Exchange; only the context of the store writes the medium.
class OperatorMemory {
 public:
  /// store, wiring, exchange: outlive this object. Not real-time safe.
  OperatorMemory(SlotStore& store, const Wiring& wiring, Exchange& exchange) noexcept
      : store_(store), wiring_(wiring), exchange_(exchange) {}

  /// Reads the stored state and puts the weights of the axes into Exchange. If a record was begun and is not
  /// readable, or if the two records differ by more than one change, the result is a deactivated correction,
  /// because the newest setting may have been a deactivation. Call once, before the first tick. Not real-time
  /// safe.
  OperatorState load() noexcept;
  /// Stores the present state if it differs from the stored state, or if a record is damaged. If the medium
  /// refuses, the next call tries again. Not real-time safe.
  void save() noexcept;
  /// True if the last write was refused: a start would restore an older state, or stay deactivated.
  bool refused() const noexcept { return refused_.load(std::memory_order_relaxed); }
  /// Ticks that the state contains that is in the store (low 32 bits of Exchange::ticks.count()), and ticks
  /// of the newest state that the medium refused. For any context.
  std::uint32_t stored_ticks() const noexcept { return stored_ticks_.load(std::memory_order_acquire); }
  std::uint32_t refused_ticks() const noexcept { return refused_ticks_.load(std::memory_order_acquire); }
  /// State of the records that load() found.
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
  int to_write_ = 0;  // times that the newest state must still be written
  std::atomic<bool> refused_{false}, damaged_{false};
  std::atomic<std::uint32_t> stored_ticks_{0}, refused_ticks_{0};
};

}  // namespace vernier
