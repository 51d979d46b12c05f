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
  /// store, wiring, exchange: outlive this object. setup.
  OperatorMemory(SlotStore& store, const Wiring& wiring, Exchange& exchange) noexcept
      : store_(store), wiring_(wiring), exchange_(exchange) {}

  /// Reads the stored state and puts the weights of the axes into Exchange. If the store has records and none
  /// of them is valid, the result is a deactivated correction. Call once, before the first tick. setup.
  OperatorState load() noexcept;
  /// Stores the present state if it differs from the stored state. If the medium refuses, the next call tries
  /// again. setup.
  void save() noexcept;
  /// True if the last write was refused: a start would restore an older state.
  bool refused() const noexcept { return refused_.load(std::memory_order_relaxed); }
  /// True if the store had records and none of them was valid.
  bool lost() const noexcept { return lost_; }

 private:
  OperatorState present() const noexcept;
  OperatorRecord read(std::uint32_t place) noexcept;
  bool is_written(std::uint32_t place) noexcept;

  SlotStore& store_;
  const Wiring& wiring_;
  Exchange& exchange_;
  OperatorRecords records_;
  OperatorState stored_;
  bool lost_ = false;
  std::atomic<bool> refused_{false};
};

}  // namespace vernier
