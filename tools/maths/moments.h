// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

namespace vernier::maths {

/// A regression problem, reduced to the data for its F tests. The reduced data are inner products of the
/// functions (regressors) with each other and with the residual, after projection on the complement of
/// earlier fits. Each function has the length 1 before the projection.
struct Moments {
  Eigen::MatrixXd gram;   // functions x functions
  Eigen::VectorXd score;  // functions
  double sum = 0;         // sum of squares of the residual
  double freedom = 0;     // degrees of freedom of the residual; not an integer after a joint fit with other
                          // kinds of readings
  /// Smallest share of a function's squared length that must remain for the function to count as independent
  /// (rounding leaves 1e-14).
  double least_remainder = 1e-6;
};

/// Part of the residual that a set of functions explains, after other functions were fitted.
struct Explained {
  double sum = 0;                          // sum of squares that the functions explain
  double rank = 0;                         // number of functions that are not combinations of earlier
                                           // functions
  double sum_before = 0, rank_before = 0;  // sum of squares and rank of the functions that were fitted before
};

using FunctionSet = std::vector<Eigen::Index>;

/// Fits the functions `adjust` first, and then the functions `subject`. The result of explained() contains
/// only the part that `subject` explains.
Explained explained(const Moments& moments, const FunctionSet& adjust, const FunctionSet& subject);

/// Returns the logarithm of the p-value of several kinds of readings together, from the explained sum of each
/// kind in units of its variance. For one kind this p-value is exact; for several kinds it is conservative.
double log_p_together(const std::vector<const Moments*>& moments, const std::vector<Explained>& parts);

/// Removes the part along `functions` from all other functions and from the residual.
void condition_on(Moments& moments, const FunctionSet& functions);

/// Returns the coefficients of the joint fit of `functions`, in their order. A function that is a combination
/// of earlier functions has the coefficient 0.
Eigen::VectorXd coefficients(const Moments& moments, const FunctionSet& functions);

/// Returns the logarithm of the p-value of the F test for the explained part: its mean square divided by the
/// mean square of the remaining residual. `inflation`: factor (at least 1) by which serial correlation
/// increases the variance of the explained sum.
double log_p(const Moments& moments, const Explained& part, double inflation = 1);

}  // namespace vernier::maths
