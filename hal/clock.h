// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "comp/quantity.h"
#include "hal/fault.h"

namespace vernier {

constexpr InstantNs instant_ns(TimeUs time) { return InstantNs(time.count * 1000); }

/// A clock whose time never decreases. The zero of the clock's time has no meaning.
class Clock {
 public:
  virtual ~Clock() = default;
  /// Returns the present time. Real-time safe.
  virtual InstantNs now() noexcept = 0;
  /// Waits until the time `due`. If the wake-up time `due` is in the past, sleep_until() returns
  /// immediately. The function sleep_until() returns kRefused if the timer failed. Real-time safe.
  virtual HalFault sleep_until(InstantNs due) noexcept = 0;
};

}  // namespace vernier
