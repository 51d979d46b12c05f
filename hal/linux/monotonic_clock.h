// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/clock.h"

namespace vernier {

/// The clock CLOCK_MONOTONIC of the operating system. A sleep ends at an absolute time. A late wake-up
/// therefore does not delay the next wake-up.
class MonotonicClock : public Clock {
 public:
  InstantNs now() noexcept override;
  HalFault sleep_until(InstantNs due) noexcept override;
};

}  // namespace vernier
