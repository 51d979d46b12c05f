// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/fixed.h"
#include "comp/quantity.h"
#include "hal/support/rounded_ratio.h"

namespace vernier {

/// Scale of an analogue output. The scale converts a correction to the code of a D/A converter, or to the
/// on-time of a pulse width in ns. The conversion is linear, is rounded to the nearest code, and is limited
/// at both ends of the range.
///
///   code = zero + round(±correction * codes / span), halves away from zero
///
/// The only rounding in this formula is that of the quotient, and this rounding is exact.
struct AnalogueScale {
  static constexpr std::int64_t kMostCounts = RoundedRatio::kMost;  // largest correction, counts; a larger
                                                                    // correction is limited to this value

  std::int64_t span = 1;           // counts of the axis (1 nm, or 2^-32 turn) that correspond to the number
                                   // `codes` of codes; > 0
  std::int64_t codes = 1;          // > 0
  std::int64_t zero = 0;           // code for the correction 0; from low to high
  std::int64_t low = 0, high = 0;  // ends of the used range, codes; 0 <= low < high
  bool inverted = false;           // true: a positive correction decreases the code

  /// True if the values of the scale are valid. Not real-time safe.
  bool valid() const noexcept {
    return span > 0 && span <= kMostCounts && codes > 0 && codes <= INT32_MAX && low >= 0 && low < high &&
           high <= INT32_MAX && zero >= low && zero <= high;
  }
  /// wanted_code returns the code of a correction without limits. code_for returns the code that is written,
  /// within the limits. In the tick of the firmware, AnalogueConverter converts corrections to codes in the
  /// same way as AnalogueScale. Not real-time safe.
  std::int64_t wanted_code(AxisTravel correction) const noexcept;
  std::int64_t code_for(AxisTravel correction) const noexcept;
  /// Returns the correction that corresponds to a code, to the nearest count. `code`: 0 to 2^31. Not
  /// real-time safe.
  AxisTravel correction_of(std::int64_t code) const noexcept {
    const std::int64_t off = RoundedRatio(span, codes).of(code - zero);
    return AxisTravel(inverted ? -off : off);
  }
};

/// Converts corrections to codes with an AnalogueScale. Real-time safe.
class AnalogueConverter {
 public:
  /// `scale`: a scale for which valid() is true. Not real-time safe.
  explicit AnalogueConverter(const AnalogueScale& scale) noexcept
      : scale_(scale), ratio_(scale.codes, scale.span) {}

  /// Returns the code of a correction, without the limits of the range. `correction`: any value. Real-time
  /// safe.
  std::int64_t wanted_code(AxisTravel correction) const noexcept {
    const std::int64_t off = ratio_.of(correction.count);
    return scale_.zero + (scale_.inverted ? -off : off);
  }
  /// Returns the code that is written, within the limits of the range. Real-time safe.
  std::int64_t code_for(AxisTravel correction) const noexcept {
    return clamp(wanted_code(correction), scale_.low, scale_.high);
  }
  const AnalogueScale& scale() const noexcept { return scale_; }

 private:
  AnalogueScale scale_;
  RoundedRatio ratio_;
};

inline std::int64_t AnalogueScale::wanted_code(AxisTravel correction) const noexcept {
  return AnalogueConverter(*this).wanted_code(correction);
}
inline std::int64_t AnalogueScale::code_for(AxisTravel correction) const noexcept {
  return AnalogueConverter(*this).code_for(correction);
}

}  // namespace vernier
