// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/fixed.h"
#include "comp/quantity.h"
#include "hal/support/rounded_ratio.h"

namespace vernier {

/// Converts a correction to the code of a converter, or to the on-time of a pulse width in ns. Linear,
/// rounded to the nearest code, limited at both ends.
///
///   code = zero + round(±correction * codes / span), halves away from zero
///
/// The quotient is the only rounding of the code, and is exact.
struct AnalogueScale {
  static constexpr std::int64_t kMostCounts = RoundedRatio::kMost;  // of a correction; beyond is held

  std::int64_t span = 1;           // counts of the axis (1 nm, or 2^-32 turn) that `codes` codes are; > 0
  std::int64_t codes = 1;          // > 0
  std::int64_t zero = 0;           // code without a correction; low .. high
  std::int64_t low = 0, high = 0;  // ends of the range that is used, codes; 0 <= low < high
  bool inverted = false;           // a positive correction lowers the code

  /// True if the scale can be used. Not real-time safe.
  bool valid() const noexcept {
    return span > 0 && span <= kMostCounts && codes > 0 && codes <= INT32_MAX && low >= 0 && low < high &&
           high <= INT32_MAX && zero >= low && zero <= high;
  }
  /// wanted_code returns the code of a correction, without limits; code_for returns the code that is written.
  /// In the tick, AnalogueConverter computes both conversions. Not real-time safe.
  std::int64_t wanted_code(AxisTravel correction) const noexcept;
  std::int64_t code_for(AxisTravel correction) const noexcept;
  /// Returns the correction that a code represents, to the nearest count. code: 0 .. 2^31.
  /// Not real-time safe.
  AxisTravel correction_of(std::int64_t code) const noexcept {
    const std::int64_t off = RoundedRatio(span, codes).of(code - zero);
    return AxisTravel(inverted ? -off : off);
  }
};

/// A scale at work. Real-time safe.
class AnalogueConverter {
 public:
  /// scale: must be valid(). Not real-time safe.
  explicit AnalogueConverter(const AnalogueScale& scale) noexcept
      : scale_(scale), ratio_(scale.codes, scale.span) {}

  /// Returns the code of a correction, without the limits of the range. correction: any. Real-time safe.
  std::int64_t wanted_code(AxisTravel correction) const noexcept {
    const std::int64_t off = ratio_.of(correction.count);
    return scale_.zero + (scale_.inverted ? -off : off);
  }
  /// Returns the code that is written. Real-time safe.
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
