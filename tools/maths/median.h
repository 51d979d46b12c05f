// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

namespace vernier::maths {

/// Returns the median of `values`. The median of an even number of values is the upper of the two middle
/// values; the median of an empty list is 0.
double median(std::vector<double> values);

/// Returns the standard deviation of a normal distribution whose median absolute value is `median_size`:
/// 1.4826 times `median_size` (Hampel 1974).
double spread_of_median(double median_size);

/// Returns the standard deviation of deviations from 0, computed from their median absolute value. Because
/// the function uses the median, outliers hardly change the result. The standard deviation of an empty list
/// is 0.
double robust_spread(std::vector<double> deviations);

}  // namespace vernier::maths
