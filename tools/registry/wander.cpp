// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/wander.h"

#include <algorithm>
#include <cmath>

#include "tools/maths/decompositions.h"

namespace vernier::registry {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of -2 log likelihood: a region that holds the truth in 95 % (chi^2 of two parameters).
constexpr double kNotExcluded = 6;

/// Lower root of the covariance of a machine's readings.
MatrixXd root_of(const WanderSeries& series, const Wander& wander) {
  const auto n = static_cast<Index>(series.row.size());
  MatrixXd covariance = MatrixXd::Identity(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index k = 0; k < n; ++k) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(k);
      covariance(i, k) += wander.ratio * series.weight[a] * series.weight[b] *
                          std::exp(-std::abs(series.days[a] - series.days[b]) / wander.days);
    }
  return Eigen::LLT<MatrixXd>(covariance).matrixL();
}

MatrixXd rows_of(const WanderSeries& series, const MatrixXd& columns) {
  MatrixXd rows(static_cast<Index>(series.row.size()), columns.cols());
  for (std::size_t i = 0; i < series.row.size(); ++i)
    rows.row(static_cast<Index>(i)) = columns.row(series.row[i]);
  return rows;
}

/// Effect of a wander on the readings.
struct Judged {
  double unlikelihood = 0;   // -2 log likelihood of all machines, but for a constant
  double rate_variance = 0;  // of a machine's own rate, on average
};

Judged judged(const std::vector<WanderSeries>& machines, const VectorXd& left, const Wander& wander) {
  double sum = 0, freedom = 0, determinants = 0, rates = 0, count = 0;
  for (const WanderSeries& series : machines) {
    const auto n = static_cast<Index>(series.row.size());
    constexpr Index kUnknowns = 2;
    if (n <= kUnknowns) continue;
    MatrixXd columns(n, kUnknowns + 1);
    for (Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      columns.row(i) << series.weight[at], series.weight[at] * (series.days[at] - series.days[0]), 0;
    }
    columns.col(kUnknowns) = rows_of(series, left);
    const MatrixXd root = root_of(series, wander);
    root.triangularView<Eigen::Lower>().solveInPlace(columns);
    const MatrixXd own = columns.leftCols(kUnknowns);
    const MatrixXd normal = own.transpose() * own;
    const double determinant = normal.determinant();
    if (!(determinant > 0)) continue;  // all at one time
    const VectorXd through = own.transpose() * columns.col(kUnknowns);
    const MatrixXd inverse = normal.inverse();
    sum += columns.col(kUnknowns).squaredNorm() - through.dot(inverse * through);
    rates += inverse(1, 1), ++count;
    freedom += static_cast<double>(n - kUnknowns);
    determinants += 2 * root.diagonal().array().log().sum() + std::log(determinant);
  }
  if (!(freedom > 0 && sum > 0)) return {};
  return {determinants + freedom * std::log(sum / freedom), rates / count * sum / freedom};
}

}  // namespace

Wander estimated_wander(const std::vector<WanderSeries>& machines, const VectorXd& left) {
  double longest = 0, shortest = 0;
  for (const WanderSeries& series : machines)
    for (std::size_t i = 1; i < series.days.size(); ++i) {
      const double step = series.days[i] - series.days[i - 1];
      if (step > 0) shortest = shortest == 0 ? step : std::min(shortest, step);
      longest = std::max(longest, series.days[i] - series.days[0]);
    }
  Wander best;
  if (longest <= 0) return best;
  std::vector<std::pair<Wander, Judged>> tried = {{best, judged(machines, left, {0, 1})}};
  const double independent = tried[0].second.unlikelihood;
  double least = independent;
  for (double days = std::max(shortest, longest / 200); days <= 8 * longest; days *= 2)
    for (double ratio = 0.125; ratio <= 1024; ratio *= 2) {
      tried.push_back({{ratio, days}, judged(machines, left, {ratio, days})});
      least = std::min(least, tried.back().second.unlikelihood);
    }
  // A rate is reported only if it is significant for all values that the readings do not exclude.
  double widest = 0;
  for (const auto& [wander, here] : tried)
    if (here.unlikelihood <= least + kNotExcluded && here.rate_variance > widest)
      widest = here.rate_variance, best = wander;
  best.gain = independent - least;
  return best;
}

void whiten(const std::vector<WanderSeries>& machines, const Wander& wander, MatrixXd& columns) {
  if (wander.ratio == 0) return;
  for (const WanderSeries& series : machines) {
    MatrixXd rows = rows_of(series, columns);
    root_of(series, wander).triangularView<Eigen::Lower>().solveInPlace(rows);
    for (std::size_t i = 0; i < series.row.size(); ++i)
      columns.row(series.row[i]) = rows.row(static_cast<Index>(i));
  }
}

}  // namespace vernier::registry
