// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

namespace vernier::plan {

/// Computes how well rows distinguish two alternatives. One alternative is true; the other, with all free
/// parameters of the model, is fitted to the rows. The non-centrality of the residual's chi^2 is
///   lambda = min over theta of |d - J theta|^2 = d'd - (J'd)' (J'J)^-1 (J'd),
/// d is the difference between the two predictions and J the Jacobian of the wrong model, both weighted by
/// 1/u (T-optimal discrimination: Atkinson and Fedorov, Biometrika 62 (1975) 57-70, eq. 2.3).
class Discrimination {
 public:
  /// `jacobian`, `difference`: weighted, one row per observation. `first`: the first observation of each row
  /// of the measurement, and one past the last. The first `existing` rows are measured; the other rows are
  /// offers.
  Discrimination(Eigen::MatrixXd jacobian, Eigen::VectorXd difference, std::vector<Eigen::Index> first,
                 std::size_t existing);

  std::size_t offers() const { return first_.size() - 1 - existing_; }
  /// Adds these offered rows (with repeats) to the existing rows; needs a factorisation.
  void assume(const std::vector<std::size_t>& chosen);
  double non_centrality() const { return lambda_; }
  /// Returns the non-centrality that each offered row would add: r' (I + J_row (J'J)^-1 J_row')^-1 r, with r
  /// its difference after the refit.
  Eigen::VectorXd gains() const;

 private:
  void add_row(std::size_t row, Eigen::MatrixXd& information, Eigen::VectorXd& moment, double& square) const;

  Eigen::MatrixXd jacobian_;  // columns of length 1
  Eigen::VectorXd difference_;
  std::vector<Eigen::Index> first_;
  std::size_t existing_;
  Eigen::MatrixXd information_, inverse_;  // of the existing rows; of all assumed
  Eigen::VectorXd moment_, solution_;
  double square_ = 0, lambda_ = 0;
};

/// Returns the non-centrality at which a chi^2 difference has the right sign with this confidence. The
/// difference of the two fits is distributed as lambda + 2 sqrt(lambda) z and must exceed `lead`. Therefore
/// sqrt(lambda) = z + sqrt(z^2 + lead). confidence: 0.5 to 1, both exclusive.
double needed_non_centrality(double confidence, double lead);

/// Returns the quantile of the standard normal distribution (bisection of erfc). p: 0 to 1, exclusive.
double normal_quantile(double p);

}  // namespace vernier::plan
