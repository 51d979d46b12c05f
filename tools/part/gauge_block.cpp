// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/gauge_block.h"

#include <numbers>
#include <stdexcept>

namespace vernier::part {

GaugeBlockEstimate estimate_gauge_block(const std::array<double, 4>& y_mm, double pivot_mm) {
  if (!(pivot_mm > 0)) throw std::invalid_argument("the pivot length must be above 0");
  // The half difference of two readings has 1/sqrt(2) of the uncertainty of one.
  constexpr double kHalfDifference = 1 / std::numbers::sqrt2;
  return {(y_mm[0] - y_mm[2]) / (2 * pivot_mm), (y_mm[3] - y_mm[1]) / 2, kHalfDifference / pivot_mm,
          kHalfDifference};
}

}  // namespace vernier::part
