// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace vernier::maths {

/// Returns the natural logarithm of the upper tail probability of an F distribution: log P(F >= f). f >= 0,
/// d1 > 0, d2 > 0; d1 and d2 need not be integers. The logarithm is returned because the p-values of an
/// accurate survey are far below the smallest double. If d2 <= 0, the variance is unknown, and the result is
/// 0 (p = 1). The relative accuracy of the tail probability p is about 1e-10. The formula is that of NIST
/// DLMF 8.17.
double log_f_tail(double f, double d1, double d2);

/// Returns the natural logarithm of the upper tail probability of a chi-square distribution: log P(X >= x),
/// with k > 0 degrees of freedom. The formulas are those of NIST DLMF 8.2 and 8.9.
double log_chi_square_tail(double x, double k);

/// Returns the upper tail probability of a chi-square distribution with k degrees of freedom: 1 for x <= 0,
/// and 0 below the smallest double.
double chi_square_tail(double x, double k);

/// upper_tail returns the probability that a standard normal variable exceeds z. upper_quantile returns the
/// value that a standard normal variable exceeds with the probability p. 0 < p < 0.5.
double upper_tail(double z);
double upper_quantile(double p);

/// Returns the value x that a chi-square variable with k > 0 degrees of freedom exceeds with the probability
/// p, 0 < p < 1. The absolute error of the returned x is at most about 1e-15 (10 k + 100).
double chi_square_point(double p, double k);

/// Returns log P(R >= r) for the correlation coefficient R of `pairs` independent pairs of normal random
/// numbers (one-sided).
double log_correlation_tail(double r, double pairs);

}  // namespace vernier::maths
