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

/// An axis whose correction is written to an output device.
struct OutputAxis {
  const SignalSource* source = nullptr;
  bool rotary = false;                     // true: spans are in degrees; false: in mm
  std::int64_t most_per_tick = INT32_MAX;  // largest change of the correction in one tick, counts
  TimeUs tick;
};

/// An axis whose position comes from a device.
struct PositionAxis {
  const SignalSource* source = nullptr;
  bool rotary = false;
};

/// Function that opens a device whose settings are already read and checked. If the device is missing, the
/// function returns null and sets `error`. Not real-time safe.
template <class Device, class Pointer = std::unique_ptr<Device>>
using Opener = std::function<Pointer(std::string& error)>;
using OutputOpener = Opener<OutputDevice>;
using ModbusLineOpener = Opener<ModbusLine, std::shared_ptr<ModbusLine>>;

}  // namespace vernier
