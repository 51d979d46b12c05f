// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/fault.h"

namespace vernier {

/// A line that the machine controller sets on or off; the polarity is already applied.
class DigitalInput {
 public:
  virtual ~DigitalInput() = default;
  /// kRefused: the line cannot be read; `on` is not changed. Real-time safe.
  virtual HalFault read_line(bool& on) noexcept = 0;
};

/// A line that the board switches, read by the machine controller.
class DigitalOutput {
 public:
  virtual ~DigitalOutput() = default;
  /// kRefused: the line may have its old state. Real-time safe.
  virtual HalFault write_line(bool on) noexcept = 0;
};

}  // namespace vernier
