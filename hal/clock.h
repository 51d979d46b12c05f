// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "comp/quantity.h"
#include "hal/fault.h"

namespace vernier {

constexpr InstantNs instant_ns(TimeUs time) { return InstantNs(time.count * 1000); }

/// A time that never decreases; the zero of the time has no meaning.
class Clock {
 public:
  virtual ~Clock() = default;
  /// Returns the time of now. Real-time safe.
  virtual InstantNs now() noexcept = 0;
  /// Returns when now() >= due, immediately if that is past. kRefused: the timer failed. Real-time safe.
  virtual HalFault sleep_until(InstantNs due) noexcept = 0;
};

}  // namespace vernier
