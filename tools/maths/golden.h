// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace vernier::maths {

struct Peak {
  double at = 0, value = 0;
};

/// Returns the position and the value of the maximum of a function between two points, by golden section
/// search. The returned maximum is the better of the last two points of the search. If the function has
/// several peaks, golden_peak finds one of them.
template <typename Function>
Peak golden_peak(const Function& value, double low, double high, int sections) {
  constexpr double kGolden = 0.381966011250105;  // 2 - (1 + sqrt 5)/2
  double a = low + kGolden * (high - low), b = high - kGolden * (high - low);
  double at_a = value(a), at_b = value(b);
  for (int k = 0; k < sections; ++k) {
    if (at_a > at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = low + kGolden * (high - low);
      at_a = value(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = high - kGolden * (high - low);
      at_b = value(b);
    }
  }
  return at_a > at_b ? Peak{a, at_a} : Peak{b, at_b};
}

}  // namespace vernier::maths
