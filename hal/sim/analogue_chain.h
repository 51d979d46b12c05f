// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "comp/quantity.h"

namespace vernier {

/// Model of the published chain from a correction to an axis. A converter gives 0..10 V, and the drive adds
/// 25 um per volt above 5 V (Aerotech A3200, encoder offset from an analogue input). A converter of b bits
/// has 2^b - 1 codes of 10 V / (2^b - 1) each. Code 2^(b-1) - 1 is calibrated to give 5 V (8 bits: code 127).
/// The codes have the same range on both sides of zero (8 bits: 127 steps of 0.980392 um = 124.5 um). The
/// pulse-width output of the publication has 8 bits.
class AnalogueChain {
 public:
  static constexpr double kNmPerVolt = 25000, kRangeVolt = 10;

  /// `bits`: 2 to 24.
  explicit AnalogueChain(unsigned bits)
      : zero_code_((std::int64_t{1} << (bits - 1)) - 1),
        step_nm_(kRangeVolt * kNmPerVolt / static_cast<double>((std::int64_t{1} << bits) - 1)) {}

  double step_nm() const { return step_nm_; }
  std::int64_t last_code() const { return 2 * zero_code_; }

  /// Returns the code nearest to a correction, limited to the first and last code.
  std::int64_t code_for(AxisTravel correction_nm) const {
    return std::clamp<std::int64_t>(wanted_code(correction_nm), 0, last_code());
  }
  /// True if the correction is beyond the range of the codes.
  bool saturates(AxisTravel correction_nm) const {
    return wanted_code(correction_nm) != code_for(correction_nm);
  }
  /// Returns the value that the drive adds to its axis, nm.
  double offset_nm(std::int64_t code) const { return static_cast<double>(code - zero_code_) * step_nm_; }

 private:
  std::int64_t wanted_code(AxisTravel correction_nm) const {
    return zero_code_ + std::llround(static_cast<double>(correction_nm.count) / step_nm_);
  }

  std::int64_t zero_code_;
  double step_nm_;
};

}  // namespace vernier
