// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "comp/quantity.h"
#include "hal/fault.h"

namespace vernier {

/// Measured quantities that are no axis (temperatures, loads), in the order of the image's inputs.
class InputReader {
 public:
  virtual ~InputReader() = default;
  /// A tick of the firmware begins; each input is read once until the next call. begin_tick() never waits.
  /// Real-time safe.
  virtual void begin_tick() noexcept {}
  /// Reads the newest value of an input, in 1e-6 of the unit that the correction image declares. kNoReading:
  /// the sensor gives no reading. Real-time safe.
  virtual HalFault read_input(std::uint32_t input, InputMicro& value) noexcept = 0;
};

}  // namespace vernier
