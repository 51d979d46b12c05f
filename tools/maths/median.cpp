// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/median.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vernier::maths {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double spread_of_median(double median_size) {
  constexpr double kMadPerSpread = 1.4826;  // of a normal distribution
  return kMadPerSpread * median_size;
}

double robust_spread(std::vector<double> deviations) {
  for (double& value : deviations) value = std::abs(value);
  return spread_of_median(median(std::move(deviations)));
}

}  // namespace vernier::maths
