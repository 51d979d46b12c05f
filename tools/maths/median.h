// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

namespace vernier::maths {

/// The middle one of `values`, of an even count the upper of the two; 0 of none. tool.
double median(std::vector<double> values);

/// Standard deviation of a normal law that has this median size (Hampel 1974: 1.4826 of it). tool.
double spread_of_median(double median_size);

/// Spread of deviations from 0, from their median size: wild ones do not move it; 0 of none. tool.
double robust_spread(std::vector<double> deviations);

}  // namespace vernier::maths
