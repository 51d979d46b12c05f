#include "tools/fit/observability.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace vernier {
namespace {

/// A part smaller than this share of a combination's largest is rounding or a detail nobody should read.
constexpr double kNamedShare = 0.02;
constexpr double kDeterminedShare = 1e-3;
/// Of a weak combination only what carries it is named.
constexpr double kWeakShare = 0.3;
constexpr Eigen::Index kWeakest = 3;

/// Reduces the rows of `basis` (k directions x n parameters) so that each is as short as elimination can make
/// it.
void eliminate(Eigen::MatrixXd& basis) {
  std::vector<char> used(static_cast<std::size_t>(basis.cols()), 0);
  for (Eigen::Index row = 0; row < basis.rows(); ++row) {
    Eigen::Index best_row = row, best_column = 0;
    double best = -1;
    for (Eigen::Index r = row; r < basis.rows(); ++r)
      for (Eigen::Index c = 0; c < basis.cols(); ++c)
        if (used[static_cast<std::size_t>(c)] == 0 && std::abs(basis(r, c)) > best) {
          best = std::abs(basis(r, c));
          best_row = r;
          best_column = c;
        }
    basis.row(row).swap(basis.row(best_row));
    used[static_cast<std::size_t>(best_column)] = 1;
    basis.row(row) /= basis(row, best_column);
    for (Eigen::Index r = 0; r < basis.rows(); ++r)
      if (r != row) basis.row(r) -= basis(r, best_column) * basis.row(row);
  }
}

/// Parameters whose part is at least `share` of the largest, largest first.
std::vector<std::size_t> parts_of(const Eigen::VectorXd& combination, double share) {
  const double largest = combination.cwiseAbs().maxCoeff();
  std::vector<std::size_t> parts;
  for (Eigen::Index c = 0; c < combination.size(); ++c)
    if (std::abs(combination[c]) >= share * largest) parts.push_back(static_cast<std::size_t>(c));
  std::stable_sort(parts.begin(), parts.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(combination[static_cast<Eigen::Index>(a)]) >
           std::abs(combination[static_cast<Eigen::Index>(b)]) + 1e-9;
  });
  return parts;
}

std::vector<std::vector<std::size_t>> name_parts(Eigen::MatrixXd basis) {
  eliminate(basis);
  std::vector<std::vector<std::size_t>> groups;
  for (Eigen::Index row = 0; row < basis.rows(); ++row)
    groups.push_back(parts_of(basis.row(row).transpose(), kNamedShare));
  return groups;
}

}  // namespace

Observability observe(const Eigen::MatrixXd& normal, double cutoff) {
  const Eigen::Index n = normal.rows();
  Observability result;
  result.covariance = Eigen::MatrixXd::Zero(n, n);
  result.determined.assign(static_cast<std::size_t>(n), 1);
  if (n == 0) return result;
  Eigen::VectorXd scale = normal.diagonal().cwiseSqrt();
  // A column that nothing sees has no length to scale by; it stays zero and becomes a direction of its own.
  const double tiny = 1e-14 * std::max(scale.maxCoeff(), 1e-300);
  for (double& s : scale) s = s > tiny ? 1 / s : 0;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  const Eigen::VectorXd& values = eigen.eigenvalues();  // increasing
  const double limit = cutoff * cutoff * std::max(values[n - 1], 1e-300);
  Eigen::Index lost = 0;
  while (lost < n && values[lost] < limit) ++lost;
  result.rank = n - lost;
  if (result.rank > 0) {
    result.condition = std::sqrt(values[n - 1] / values[lost]);
    const Eigen::MatrixXd seen = scale.asDiagonal() * eigen.eigenvectors().rightCols(result.rank);
    result.covariance = seen * values.tail(result.rank).cwiseInverse().asDiagonal() * seen.transpose();
  }
  if (lost == 0) return result;
  const Eigen::MatrixXd unseen = eigen.eigenvectors().leftCols(lost);
  for (Eigen::Index i = 0; i < n; ++i)
    if (unseen.row(i).norm() > kDeterminedShare) result.determined[static_cast<std::size_t>(i)] = 0;
  result.unidentifiable = name_parts(unseen.transpose());
  return result;
}

}  // namespace vernier
