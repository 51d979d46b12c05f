// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/clock.h"
#include "hal/fault.h"

namespace vernier {

/// The signal of the controller at the beginning of its cycle. Each signal starts a tick.
class TickSync {
 public:
  virtual ~TickSync() = default;
  /// Waits for the next sync signal. The function wait_for_sync() returns kNoReading if no signal came until
  /// `latest`. If the sync device is defective, wait_for_sync() returns kRefused immediately. If
  /// several signals came since the last call, they count as one signal. Real-time safe.
  virtual HalFault wait_for_sync(InstantNs latest) noexcept = 0;
};

}  // namespace vernier
