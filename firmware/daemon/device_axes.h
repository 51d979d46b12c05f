// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"
#include "firmware/daemon/settings/signal_source.h"

namespace vernier {

/// An axis whose correction leaves through an output.
struct OutputAxis {
  const SignalSource* source = nullptr;
  bool rotary = false;                     // spans are in degrees, else in mm
  std::int64_t most_per_tick = INT32_MAX;  // largest change of the correction in a tick, counts
  TimeUs tick;
};

/// An axis whose position comes from a device.
struct PositionAxis {
  const SignalSource* source = nullptr;
  bool rotary = false;
};

}  // namespace vernier
