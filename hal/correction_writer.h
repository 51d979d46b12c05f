// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "comp/quantity.h"
#include "hal/fault.h"

namespace vernier {

/// Sends corrections to the controller: the values that are added to the command of an axis.
class CorrectionWriter {
 public:
  virtual ~CorrectionWriter() = default;
  /// correction: axis counts (1 nm, or 2^-32 turn). After a fault the device has the old or the new value.
  /// Real-time safe.
  virtual HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept = 0;
  /// Returns the output of the device for a correction: the correction, or the end of the device's range.
  /// Real-time safe.
  virtual AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept {
    return static_cast<void>(axis), correction;
  }
};

}  // namespace vernier
