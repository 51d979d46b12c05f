// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "comp/quantity.h"
#include "hal/fault.h"

namespace vernier {

/// Sends corrections to the controller. A correction is a value that is added to the command of an axis.
class CorrectionWriter {
 public:
  virtual ~CorrectionWriter() = default;
  /// `correction`: in counts of the axis (1 nm, or 2^-32 turn). If the write of a correction fails,
  /// the device has either the old or the new correction. Real-time safe.
  virtual HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept = 0;
  /// Returns the value that the device can output for a correction: the correction itself, or the end of the
  /// device's range. Real-time safe.
  virtual AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept {
    return static_cast<void>(axis), correction;
  }
};

}  // namespace vernier
