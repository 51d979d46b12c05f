// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cmath>

namespace vernier::maths {

/// Returns the multiple of `digit` (a power of ten) that is nearest to a value. The function rounded_to()
/// returns the double number with the shortest decimal text: 242.1, not 242.10000000000002. A multiplication
/// by 0.1 does not give the number with the shortest text.
inline double rounded_to(double value, double digit) {
  const double inverse = std::round(1 / digit);
  return inverse >= 1 ? std::round(value * inverse) / inverse : std::round(value / digit) * digit;
}

/// Returns the largest power of ten that is at most the value (value > 0).
inline double decade(double value) { return std::pow(10, std::floor(std::log10(value))); }

/// Returns a value (not 0) rounded to two significant digits.
inline double to_two_digits(double value) {
  return rounded_to(value, std::pow(10, std::floor(std::log10(std::abs(value))) - 1));
}

}  // namespace vernier::maths
