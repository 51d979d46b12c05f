// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "comp/quantity.h"

namespace vernier {

/// From a correction to the code of a converter, or to the on-time of a pulse width in ns: linear, rounded to
/// the nearest code, held at both ends.
///
///   code = zero + round(±correction * codes / span), halves away from zero
///
/// The quotient is the only rounding: |correction| and codes below 2^26 give the mathematically nearest code.
struct AnalogueScale {
  static constexpr std::int64_t kMostCounts = std::int64_t{1} << 50;  // of a correction; beyond is held

  std::int64_t span = 1;           // counts of the axis (1 nm, or 2^-32 turn) that `codes` codes are; > 0
  std::int64_t codes = 1;          // > 0
  std::int64_t zero = 0;           // code without a correction; low .. high
  std::int64_t low = 0, high = 0;  // ends of the range that is used, codes; 0 <= low < high
  bool inverted = false;           // a positive correction lowers the code

  /// Is it usable? setup.
  bool valid() const noexcept {
    return span > 0 && span <= kMostCounts && codes > 0 && codes <= INT32_MAX && low >= 0 && low < high &&
           high <= INT32_MAX && zero >= low && zero <= high;
  }
  /// Code of a correction, beyond the ends too. correction: any. realtime.
  std::int64_t wanted_code(AxisTravel correction) const noexcept {
    constexpr double kMost = static_cast<double>(kMostCounts);
    const auto counts = static_cast<double>(std::clamp(correction.count, -kMostCounts, kMostCounts));
    const double off = std::round(counts * static_cast<double>(codes) / static_cast<double>(span));
    const auto held = static_cast<std::int64_t>(std::clamp(off, -kMost, kMost));
    return zero + (inverted ? -held : held);
  }
  /// Code that is written. realtime.
  std::int64_t code_for(AxisTravel correction) const noexcept {
    return std::clamp(wanted_code(correction), low, high);
  }
  /// Correction that a code stands for, to the nearest count. code: 0 .. 2^31. setup.
  AxisTravel correction_of(std::int64_t code) const noexcept {
    const double off =
        static_cast<double>(code - zero) * static_cast<double>(span) / static_cast<double>(codes);
    return AxisTravel(static_cast<std::int64_t>(std::llround(inverted ? -off : off)));
  }
};

}  // namespace vernier
