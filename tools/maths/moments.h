// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

namespace vernier::maths {

/// A regression, reduced to the data for its F tests: inner products of the functions with one
/// another and with the residual, after projection on the complement of earlier fits. Functions
/// have length 1 before the projection.
struct Moments {
  Eigen::MatrixXd gram;   // functions x functions
  Eigen::VectorXd score;  // functions
  double sum = 0;         // of squares of the residual
  double freedom = 0;     // of the residual, not an integer after a fit shared with other kinds
  /// Share of a function's squared length that must remain for the function to count as independent (rounding
  /// leaves 1e-14).
  double least_remainder = 1e-6;
};

/// Part that a set of functions explains, after other functions were fitted first.
struct Explained {
  double sum = 0;                          // of squares
  double rank = 0;                         // functions that are not combinations of earlier ones
  double sum_before = 0, rank_before = 0;  // of the functions that were fitted first
};

using FunctionSet = std::vector<Eigen::Index>;

/// First `adjust` is fitted, then `subject`. The result counts only the part that `subject` explains.
Explained explained(const Moments& moments, const FunctionSet& adjust, const FunctionSet& subject);

/// Returns log p of several kinds together, from the explained sum of each kind in units of its variance. The
/// result is exact for one kind and conservative for several kinds.
double log_p_together(const std::vector<const Moments*>& moments, const std::vector<Explained>& parts);

/// Removes `functions` from all other functions and from the residual.
void condition_on(Moments& moments, const FunctionSet& functions);

/// Returns the coefficients of the joint fit of `functions`, in their order; 0 for combinations of earlier
/// functions.
Eigen::VectorXd coefficients(const Moments& moments, const FunctionSet& functions);

/// Returns log p of the F test of the explained part: its mean square divided by the mean square of the rest.
/// `inflation`: factor by which serial correlation increases the variance of the explained sum, at least 1.
double log_p(const Moments& moments, const Explained& part, double inflation = 1);

}  // namespace vernier::maths
