// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

namespace vernier::maths {

/// Returns the median of `values`, of an even count the upper of the two; 0 for an empty list.
double median(std::vector<double> values);

/// Returns the standard deviation of a normal distribution with this median size: 1.4826 of the median size
/// (Hampel 1974).
double spread_of_median(double median_size);

/// Returns the standard deviation of deviations from 0, computed from their median size: outliers do not
/// change the result. 0 for an empty list.
double robust_spread(std::vector<double> deviations);

}  // namespace vernier::maths
