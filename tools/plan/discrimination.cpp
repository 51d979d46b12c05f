// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/discrimination.h"

#include <cmath>

#include "tools/maths/chance.h"
#include "tools/maths/decompositions.h"

namespace vernier::plan {
namespace {

/// Of a column's squared length over all rows: directions that the rows show less than this are
/// free.
constexpr double kRidge = 1e-10;

}  // namespace

Discrimination::Discrimination(Eigen::MatrixXd jacobian, Eigen::VectorXd difference,
                               std::vector<Eigen::Index> first, std::size_t existing)
    : jacobian_(std::move(jacobian)),
      difference_(std::move(difference)),
      first_(std::move(first)),
      existing_(existing) {
  for (Eigen::Index j = 0; j < jacobian_.cols(); ++j)
    if (const double length = jacobian_.col(j).norm(); length > 0) jacobian_.col(j) /= length;
  const Eigen::Index count = first_[existing_];
  const auto old = jacobian_.topRows(count);
  information_ = old.transpose() * old;
  information_.diagonal().array() += kRidge;
  moment_ = old.transpose() * difference_.head(count);
  square_ = difference_.head(count).squaredNorm();
  assume({});
}

void Discrimination::add_row(std::size_t row, Eigen::MatrixXd& information, Eigen::VectorXd& moment,
                             double& square) const {
  const auto j = jacobian_.middleRows(first_[row], first_[row + 1] - first_[row]);
  const auto d = difference_.segment(first_[row], j.rows());
  information.noalias() += j.transpose() * j;
  moment.noalias() += j.transpose() * d;
  square += d.squaredNorm();
}

void Discrimination::assume(const std::vector<std::size_t>& chosen) {
  Eigen::MatrixXd information = information_;
  Eigen::VectorXd moment = moment_;
  double square = square_;
  for (const std::size_t offer : chosen) add_row(existing_ + offer, information, moment, square);
  const Eigen::LDLT<Eigen::MatrixXd> factor(information);
  inverse_ = factor.solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  solution_ = factor.solve(moment);
  lambda_ = std::max(0.0, square - moment.dot(solution_));
}

Eigen::VectorXd Discrimination::gains() const {
  const Eigen::Index from = first_[existing_], count = jacobian_.rows() - from;
  const auto offered = jacobian_.bottomRows(count);
  const Eigen::MatrixXd spread = offered * inverse_;
  const Eigen::VectorXd rest = difference_.tail(count) - offered * solution_;
  Eigen::VectorXd gains(static_cast<Eigen::Index>(offers()));
  for (std::size_t offer = 0; offer < offers(); ++offer) {
    const Eigen::Index at = first_[existing_ + offer] - from;
    const Eigen::Index size = first_[existing_ + offer + 1] - from - at;
    Eigen::MatrixXd covariance = spread.middleRows(at, size) * offered.middleRows(at, size).transpose();
    covariance.diagonal().array() += 1;
    const Eigen::VectorXd r = rest.segment(at, size);
    gains[static_cast<Eigen::Index>(offer)] = std::max(0.0, r.dot(maths::solve_positive(covariance, r)));
  }
  return gains;
}

double needed_non_centrality(double confidence, double lead) {
  const double z = maths::upper_quantile(1 - confidence);
  const double root = z + std::sqrt(z * z + lead);
  return root * root;
}

double beyond_one_step(const PredictedEffect& effect, double confidence, double lead, double price) {
  Eigen::MatrixXd free = effect.free;
  for (Eigen::Index j = 0; j < free.cols(); ++j)
    if (const double length = free.col(j).norm(); length > 0) free.col(j) /= length;
  const auto left = [](const Eigen::MatrixXd& columns, const Eigen::MatrixXd& of) -> Eigen::MatrixXd {
    return columns.cols() == 0 ? of : Eigen::MatrixXd(of - columns * maths::least_norm(columns, of));
  };
  const Eigen::VectorXd readings = left(free, effect.readings).col(0);
  double worst = 1e300;
  for (const Eigen::Index place : effect.places) {
    if (place == 0) continue;
    Eigen::MatrixXd both(readings.size(), 2);
    both << effect.constant, effect.constant;
    both.col(0).head(place).setZero();
    both = left(free, both);
    const double alone = left(both.leftCols(1), readings).squaredNorm(),
                 beside = left(both, readings).squaredNorm();
    worst = std::min({worst, alone / needed_non_centrality(confidence, lead),
                      beside / needed_non_centrality(confidence, std::max(0.0, lead - price))});
  }
  return worst;
}

}  // namespace vernier::plan
