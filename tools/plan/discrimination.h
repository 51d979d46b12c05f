// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

namespace vernier::plan {

/// Computes how well rows of a measurement distinguish two alternative models. One model is true. The other
/// model, with all its free parameters, is fitted to the rows. The non-centrality of the residual's chi^2 is
///   lambda = min over theta of |d - J theta|^2 = d'd - (J'd)' (J'J)^-1 (J'd),
/// Here d is the difference between the two predictions and J the Jacobian of the wrong model, both weighted
/// by 1/u (T-optimal discrimination: Atkinson and Fedorov, Biometrika 62 (1975) 57-70, eq. 2.3).
class Discrimination {
 public:
  /// `jacobian`, `difference`: J and d, weighted, with one row per observation. `first`: index of the first
  /// observation of each row of the measurement, and at the end the number of observations. The first
  /// `existing` rows are measured; the other rows are offered for the next measurement.
  Discrimination(Eigen::MatrixXd jacobian, Eigen::VectorXd difference, std::vector<Eigen::Index> first,
                 std::size_t existing);

  std::size_t offers() const { return first_.size() - 1 - existing_; }
  /// Adds the offered rows `chosen` (a row may occur several times) to the existing rows. The function needs
  /// one matrix factorisation.
  void assume(const std::vector<std::size_t>& chosen);
  double non_centrality() const { return lambda_; }
  /// Returns the increase of the non-centrality by each offered row: r' (I + J_row (J'J)^-1 J_row')^-1 r. In
  /// this formula, r is the difference of the predictions of the offered row after the refit.
  Eigen::VectorXd gains() const;

 private:
  void add_row(std::size_t row, Eigen::MatrixXd& information, Eigen::VectorXd& moment, double& square) const;

  Eigen::MatrixXd jacobian_;  // columns are scaled to length 1
  Eigen::VectorXd difference_;
  std::vector<Eigen::Index> first_;
  std::size_t existing_;
  Eigen::MatrixXd information_, inverse_;  // information_: of the existing rows; inverse_: of all assumed
                                           // rows
  Eigen::VectorXd moment_, solution_;
  double square_ = 0, lambda_ = 0;
};

/// Returns the required non-centrality: with it, the chi^2 difference of two fits has the right sign with the
/// probability `confidence`. The chi^2 difference of the two fits has the distribution lambda + 2
/// sqrt(lambda) z, with z standard normal, and must exceed `lead`. The required probability gives
/// sqrt(lambda) = z + sqrt(z^2 + lead). `confidence`: between 0.5 and 1, without the limits.
double needed_non_centrality(double confidence, double lead);

/// An effect of an input in planned and measured rows, in units of u.
struct PredictedEffect {
  Eigen::VectorXd readings;          // what the effect adds to each reading
  Eigen::VectorXd constant;          // the same if its inputs never changed
  Eigen::MatrixXd free;              // Jacobian of the other parameters
  std::vector<Eigen::Index> places;  // first reading of each run, and of each value of the inputs
};

/// How far the readings reject one change of the machine in place of the effect: the same error with one step
/// from one of the places on, alone or beside a constant size. Returns the smallest chi^2 that remains after
/// the refit, divided by the one that is needed; 1 or more: a diagnosis does not confuse the two. `price`: of
/// one unknown in the BIC.
double beyond_one_step(const PredictedEffect& effect, double confidence, double lead, double price);

}  // namespace vernier::plan
