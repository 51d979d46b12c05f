// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>

#include "hal/clock.h"

namespace vernier {

/** This computer's own monotonic clock, for what a test or bench times; nothing sleeps by it. */
class SteadyClock final : public Clock {
 public:
  InstantNs now() noexcept override {
    return InstantNs(std::chrono::steady_clock::now().time_since_epoch().count());
  }
  HalFault sleep_until(InstantNs) noexcept override { return HalFault::kNone; }
};

}  // namespace vernier
