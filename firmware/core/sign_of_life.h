// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "hal/clock.h"

namespace vernier {

/// Determines when a watchdog may be triggered: four times a second, and only if the tick ran since the last
/// trigger. A trigger therefore shows that the tick runs, and not only that the thread of the caller runs.
class SignOfLife {
 public:
  static constexpr InstantNs kPeriod{250'000'000};  // an eighth of the time WatchdogSec in the systemd unit

  explicit SignOfLife(InstantNs now) noexcept : told_(now) {}
  /// True if the watchdog may be triggered now. `ticks`: number of ticks that ran until now. Not real-time
  /// safe.
  bool due(std::uint64_t ticks, InstantNs now) noexcept {
    if (now - told_ < kPeriod || ticks == ticks_) return false;
    ticks_ = ticks;
    told_ = now;
    return true;
  }

 private:
  std::uint64_t ticks_ = 0;
  InstantNs told_;
};

}  // namespace vernier
