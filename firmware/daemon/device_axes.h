// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "comp/quantity.h"
#include "firmware/daemon/settings/signal_source.h"

namespace vernier {

class ModbusLine;
class OutputDevice;

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

/// Opens a device whose settings are read and checked already. Null with `error` set if it is missing.
/// Not real-time safe.
template <class Device, class Pointer = std::unique_ptr<Device>>
using Opener = std::function<Pointer(std::string& error)>;
using OutputOpener = Opener<OutputDevice>;
using ModbusLineOpener = Opener<ModbusLine, std::shared_ptr<ModbusLine>>;

}  // namespace vernier
