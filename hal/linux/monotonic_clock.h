// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/clock.h"

namespace vernier {

/// The clock CLOCK_MONOTONIC. Sleeps are absolute, so that a late wake-up does not shift the next.
class MonotonicClock : public Clock {
 public:
  InstantNs now() noexcept override;
  HalFault sleep_until(InstantNs due) noexcept override;
};

}  // namespace vernier
