// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

namespace vernier::maths {

/// A regression reduced to what its F tests need: inner products of the functions with one another and with
/// the residual, after projection on the complement of what was fitted before. Functions have length 1 before
/// it.
struct Moments {
  Eigen::MatrixXd gram;   // functions x functions
  Eigen::VectorXd score;  // functions
  double sum = 0;         // of squares of the residual
  double freedom = 0;     // of the residual, not whole after a fit shared with other kinds
  /// Share of a function's squared length that must remain for it to count as one of its own (rounding leaves
  /// 1e-14).
  double least_remainder = 1e-6;
};

/// What a set of functions explains, after others had their chance.
struct Explained {
  double sum = 0;                          // of squares
  double rank = 0;                         // functions that are no combination of those before
  double sum_before = 0, rank_before = 0;  // of those that had their chance first
};

using FunctionSet = std::vector<Eigen::Index>;

/// `adjust` first, then `subject`; only the latter counts. tool.
Explained explained(const Moments& moments, const FunctionSet& adjust, const FunctionSet& subject);

/// log p of several kinds together: each kind's sum in units of its own variance. Exact for one kind, on the
/// safe side for more. tool.
double log_p_together(const std::vector<const Moments*>& moments, const std::vector<Explained>& parts);

/// Takes `functions` out of all others and out of the residual. tool.
void condition_on(Moments& moments, const FunctionSet& functions);

/// Coefficients of the joint fit of `functions` (0 for those that are a combination of others before), in
/// their order. tool.
Eigen::VectorXd coefficients(const Moments& moments, const FunctionSet& functions);

/// log p of the F test of what was explained: its mean square over the rest's. `inflation`: factor by which
/// serial correlation widens the variance of the explained sum, at least 1. tool.
double log_p(const Moments& moments, const Explained& part, double inflation = 1);

}  // namespace vernier::maths
