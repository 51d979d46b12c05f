// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/fault.h"

namespace vernier {

/// A digital input that the machine controller sets. The polarity is already applied.
class DigitalInput {
 public:
  virtual ~DigitalInput() = default;
  /// The function read_line() returns kRefused if the line cannot be read; `on` is not changed in this case.
  /// Real-time safe.
  virtual HalFault read_line(bool& on) noexcept = 0;
};

/// A digital output that the board sets and the machine controller reads.
class DigitalOutput {
 public:
  virtual ~DigitalOutput() = default;
  /// If writing an output line gives kRefused, the line may still have its old state. Real-time safe.
  virtual HalFault write_line(bool on) noexcept = 0;
};

}  // namespace vernier
