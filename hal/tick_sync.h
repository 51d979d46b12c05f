// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/clock.h"
#include "hal/fault.h"

namespace vernier {

/// The controller's signal that its cycle begins; each signal starts a tick.
class TickSync {
 public:
  virtual ~TickSync() = default;
  /// Waits for the next sync signal. kNoReading: no signal came until `latest`; kRefused: the device is
  /// broken, returned immediately. Several signals since the last call count as one signal. Real-time safe.
  virtual HalFault wait_for_sync(InstantNs latest) noexcept = 0;
};

}  // namespace vernier
