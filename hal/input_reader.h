// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "comp/quantity.h"
#include "hal/fault.h"

namespace vernier {

/// Reads measured quantities that are not axes (temperatures, loads), in the order of the inputs in the
/// image.
class InputReader {
 public:
  virtual ~InputReader() = default;
  /// Begins a tick of the firmware. In one tick of the firmware, each input is read only once. The
  /// function begin_tick() never waits. Real-time safe.
  virtual void begin_tick() noexcept {}
  /// Reads the newest value of an input, in 1e-6 of the unit that the correction image declares. The function
  /// read_input() returns kNoReading if the sensor gives no reading. Real-time safe.
  virtual HalFault read_input(std::uint32_t input, InputMicro& value) noexcept = 0;
};

}  // namespace vernier
