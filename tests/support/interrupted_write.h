// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <type_traits>

#include "firmware/core/cycle/exchange.h"

namespace vernier {

/// Leaves a published value as its writer leaves it when the processor interrupts it in the middle of
/// publish(): the turn is odd until this object is destroyed.
template <class T>
class InterruptedWrite {
 public:
  explicit InterruptedWrite(Published<T>& value)
      : turn_(reinterpret_cast<std::atomic<std::uint32_t>&>(value)) {
    // The first member of a class of standard layout has the address of the class.
    static_assert(std::is_standard_layout_v<Published<T>>);
    turn_.fetch_add(1);
  }
  ~InterruptedWrite() { turn_.fetch_add(1); }
  InterruptedWrite(const InterruptedWrite&) = delete;
  InterruptedWrite& operator=(const InterruptedWrite&) = delete;

 private:
  std::atomic<std::uint32_t>& turn_;
};

}  // namespace vernier
