// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/fault.h"

namespace vernier {

/// A line that is on or off, after its polarity is applied, as the machine controller sets it.
class DigitalInput {
 public:
  virtual ~DigitalInput() = default;
  /// kRefused: the line cannot be read; `on` is not changed. realtime.
  virtual HalFault read_line(bool& on) noexcept = 0;
};

/// A line that the board switches, read by the machine controller.
class DigitalOutput {
 public:
  virtual ~DigitalOutput() = default;
  /// kRefused: the line may be as it was. realtime.
  virtual HalFault write_line(bool on) noexcept = 0;
};

}  // namespace vernier
