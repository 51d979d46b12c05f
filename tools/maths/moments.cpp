// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/moments.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/maths/chance.h"

namespace vernier::maths {
namespace {

/// Gaussian elimination of the leading functions of a small symmetric system, one pivot at a time.
struct Sweep {
  Eigen::MatrixXd gram;
  Eigen::VectorXd score;
  double least;

  Sweep(const Moments& moments, const FunctionSet& which) : least(moments.least_remainder) {
    const auto n = static_cast<Eigen::Index>(which.size());
    gram.resize(n, n);
    score.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      score[i] = moments.score[which[static_cast<std::size_t>(i)]];
      for (Eigen::Index k = 0; k < n; ++k)
        gram(i, k) = moments.gram(which[static_cast<std::size_t>(i)], which[static_cast<std::size_t>(k)]);
    }
  }

  /// Returns the explained sum of squares of pivot i; 0 if it is a combination of earlier ones.
  double take(Eigen::Index i, bool& counts) {
    const Eigen::Index rest = gram.rows() - i - 1;
    const double pivot = gram(i, i);
    counts = pivot > least;
    if (!counts) return 0;
    const double amount = score[i] * score[i] / pivot;
    const Eigen::VectorXd factor = gram.col(i).tail(rest) / pivot;
    score.tail(rest) -= factor * score[i];
    gram.bottomRightCorner(rest, rest).noalias() -= factor * gram.row(i).tail(rest);
    return amount;
  }
};

}  // namespace

Explained explained(const Moments& moments, const FunctionSet& adjust, const FunctionSet& subject) {
  FunctionSet all = adjust;
  all.insert(all.end(), subject.begin(), subject.end());
  Sweep sweep(moments, all);
  Explained part;
  for (std::size_t i = 0; i < all.size(); ++i) {
    bool counts = false;
    const double amount = sweep.take(static_cast<Eigen::Index>(i), counts);
    if (!counts) continue;
    (i < adjust.size() ? part.sum_before : part.sum) += amount;
    (i < adjust.size() ? part.rank_before : part.rank) += 1;
  }
  return part;
}

void condition_on(Moments& moments, const FunctionSet& functions) {
  for (const Eigen::Index i : functions) {
    const double pivot = moments.gram(i, i);
    if (pivot <= moments.least_remainder) continue;
    const Eigen::VectorXd column = moments.gram.col(i);
    moments.sum = std::max(0.0, moments.sum - moments.score[i] * moments.score[i] / pivot);
    moments.score -= column * (moments.score[i] / pivot);
    moments.gram.noalias() -= column * column.transpose() / pivot;
    moments.gram.row(i).setZero();
    moments.gram.col(i).setZero();
    moments.score[i] = 0;
    moments.freedom -= 1;
  }
}

Eigen::VectorXd coefficients(const Moments& moments, const FunctionSet& functions) {
  const auto n = static_cast<Eigen::Index>(functions.size());
  Sweep sweep(moments, functions);
  std::vector<char> taken(functions.size(), 0);
  for (Eigen::Index i = 0; i < n; ++i) {
    bool counts = false;
    sweep.take(i, counts);
    taken[static_cast<std::size_t>(i)] = counts ? 1 : 0;
  }
  // Back substitution over the pivots; row i of the swept matrix holds the i-th equation.
  Eigen::VectorXd beta = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = n - 1; i >= 0; --i) {
    if (taken[static_cast<std::size_t>(i)] == 0) continue;
    const Eigen::Index rest = n - i - 1;
    beta[i] = (sweep.score[i] - sweep.gram.row(i).tail(rest).dot(beta.tail(rest))) / sweep.gram(i, i);
  }
  return beta;
}

namespace {

double rest_freedom(const Moments& moments, const Explained& part) {
  return moments.freedom - part.rank_before - part.rank;
}

/// Returns the variance of the residual after everything is removed; 0 if no degree of freedom
/// remains.
double rest_variance(const Moments& moments, const Explained& part) {
  const double rest = moments.sum - part.sum_before - part.sum;
  return rest > 1e-14 * moments.sum ? rest / rest_freedom(moments, part) : 0;
}

}  // namespace

double log_p(const Moments& moments, const Explained& part, double inflation) {
  const double freedom = rest_freedom(moments, part);
  if (part.rank <= 0 || freedom <= 0 || !(part.sum > 0)) return 0;
  const double variance = rest_variance(moments, part);
  if (variance <= 0) return -std::numeric_limits<double>::infinity();
  return log_f_tail(part.sum / part.rank / variance / inflation, part.rank, freedom / inflation);
}

double log_p_together(const std::vector<const Moments*>& moments, const std::vector<Explained>& parts) {
  double sum = 0, rank = 0, freedom = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double free = rest_freedom(*moments[i], parts[i]);
    if (parts[i].rank <= 0 || free <= 0) continue;
    const double variance = rest_variance(*moments[i], parts[i]);
    if (variance <= 0) {
      if (parts[i].sum > 0) return -std::numeric_limits<double>::infinity();
      continue;
    }
    sum += parts[i].sum / variance;
    rank += parts[i].rank;
    // The kinds' variances are estimated separately. The least certain one counts for all.
    freedom = std::min(freedom, free);
  }
  return rank > 0 ? log_f_tail(sum / rank, rank, freedom) : 0;
}

}  // namespace vernier::maths
