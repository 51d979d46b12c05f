// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/least_squares/observability.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/maths/decompositions.h"
#include "tools/maths/pivoted_cholesky.h"

namespace vernier::fit {
namespace {

/// A part smaller than this share of a combination's largest part is rounding or a negligible
/// detail.
constexpr double kNamedShare = 0.02;
constexpr double kDeterminedShare = 1e-3;
/// For a weak combination, only the main parameters are named.
constexpr double kWeakShare = 0.3;
constexpr Eigen::Index kWeakest = 3;

/// Reduces the rows of `basis` (k directions x n parameters), so that elimination makes each as
/// short as possible.
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

/// Returns the parameters whose part is at least `share` of the largest, largest first.
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

/// Scales columns to unit length. A column without any reading stays zero and becomes a direction
/// of its own.
Eigen::VectorXd unit_scale(const Eigen::MatrixXd& normal) {
  const Eigen::VectorXd length = normal.diagonal().cwiseSqrt();
  const double tiny = 1e-14 * std::max(length.maxCoeff(), 1e-300);
  return length.unaryExpr([tiny](double s) { return s > tiny ? 1 / s : 0.0; });
}

/// The decomposition of the scaled normal matrix: the result of observe() before it is scaled
/// back.
struct Parts {
  Eigen::Index rank = 0;
  Eigen::VectorXd weak_squares;  // of the identified directions, smallest first, at most kWeakest
  Eigen::MatrixXd weak;          // their directions
  double largest = 0;
  Eigen::MatrixXd unseen;   // n x (n - rank), orthonormal
  Eigen::MatrixXd inverse;  // over the identified directions
};

Parts by_eigenvectors(const Eigen::MatrixXd& scaled, double limit_share) {
  const Eigen::Index n = scaled.rows();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  const Eigen::VectorXd& values = eigen.eigenvalues();  // increasing
  Parts parts;
  parts.largest = std::max(values[n - 1], 1e-300);
  Eigen::Index lost = 0;
  while (lost < n && values[lost] < limit_share * parts.largest) ++lost;
  parts.rank = n - lost;
  parts.unseen = eigen.eigenvectors().leftCols(lost);
  const Eigen::Index weak = std::min(kWeakest, parts.rank);
  parts.weak_squares = values.segment(lost, weak);
  parts.weak = eigen.eigenvectors().middleCols(lost, weak);
  const Eigen::MatrixXd seen = eigen.eigenvectors().rightCols(parts.rank);
  parts.inverse = seen * values.tail(parts.rank).cwiseInverse().asDiagonal() * seen.transpose();
  return parts;
}

/// a - v v^T a - a v v^T + v v^T a v v^T for a symmetric a: without its part along the orthonormal
/// v.
Eigen::MatrixXd without(const Eigen::MatrixXd& a, const Eigen::MatrixXd& v) {
  if (v.cols() == 0) return a;
  const Eigen::MatrixXd along = a * v;
  const Eigen::MatrixXd half = along - 0.5 * v * (v.transpose() * along);
  return a - half * v.transpose() - v * half.transpose();
}

double largest_eigenvalue(const Eigen::MatrixXd& matrix) {
  Eigen::VectorXd v = Eigen::VectorXd::Ones(matrix.rows()).normalized();
  double value = 0;
  for (int i = 0; i < 30; ++i) {  // to a percent or two, sufficient for a scale
    v = matrix * v;
    value = v.norm();
    if (value == 0) return 0;
    v /= value;
  }
  return value;
}

/// Finds the smallest eigenvalues of the part that the pivots identify, by inverse iteration on a few more
/// vectors than are needed, and takes those below `limit` out of it. Returns false if there can be more than
/// were found, or if one of them is so near the limit that rounding decides.
bool find_weak(Parts& parts, double limit) {
  constexpr int kTurns = 12, kMostTurns = 60;  // of the iteration, from one look at its error to the next
  constexpr double kConverged = 1e-8;          // of an eigenvalue
  constexpr double kNear = 1e-3;               // of the limit
  const Eigen::Index n = parts.inverse.rows(), width = std::min(parts.rank, 3 * kWeakest);
  Eigen::MatrixXd v = Eigen::MatrixXd::NullaryExpr(n, width, [](Eigen::Index i, Eigen::Index k) {
    return std::cos(static_cast<double>((i + 1) * (k + 1)));
  });
  Eigen::VectorXd square;  // smallest first
  Eigen::Index lost = 0;
  bool settled = false;
  for (int turn = 0; turn < kMostTurns && !settled; turn += kTurns) {
    for (int i = 0; i < kTurns; ++i) v = maths::thin_q(parts.inverse * v);
    const Eigen::MatrixXd image = parts.inverse * v;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz(v.transpose() * image);
    square = ritz.eigenvalues().reverse().cwiseInverse();
    const Eigen::MatrixXd turned = ritz.eigenvectors().rowwise().reverse();
    v *= turned;
    lost = (square.array() < limit).count();
    const Eigen::MatrixXd off = image * turned - v * square.cwiseInverse().asDiagonal();
    settled = (off.colwise().norm().head(lost).array() <
               kConverged * square.head(lost).transpose().array().inverse())
                  .all();
  }
  const bool all_found = width == parts.rank || square[width - 1] >= 2 * limit;
  const Eigen::Index wanted = std::min(kWeakest, parts.rank - lost);
  if (!settled || !all_found || wanted == 0 || width - lost < wanted ||
      ((square.array() / limit - 1).abs() < kNear).any())
    return false;
  if (lost > 0) {
    const Eigen::MatrixXd below = v.leftCols(lost);
    parts.inverse -= below * square.head(lost).cwiseInverse().asDiagonal() * below.transpose();
    parts.rank -= lost;
    parts.unseen.conservativeResize(Eigen::NoChange, parts.unseen.cols() + lost);
    parts.unseen.rightCols(lost) = below;
  }
  parts.weak_squares = square.segment(lost, wanted);
  parts.weak = v.middleCols(lost, wanted);
  return true;
}

/// Returns nullopt if a direction is so near the limit that only the eigenvalues can decide.
std::optional<Parts> by_pivots(const Eigen::MatrixXd& scaled, double limit_share) {
  const Eigen::Index n = scaled.rows();
  Parts parts;
  parts.largest = largest_eigenvalue(scaled);
  const double limit = limit_share * parts.largest;
  // A remaining square is an upper bound of the smallest remaining eigenvalue. n times it is an
  // upper bound of the largest.
  const maths::PivotedCholesky factor(scaled, limit / static_cast<double>(n));
  parts.rank = factor.rank();
  if (parts.rank == 0) return std::nullopt;
  parts.unseen = factor.null_basis();
  parts.inverse = without(factor.inverse(), parts.unseen);
  if (!find_weak(parts, limit)) return std::nullopt;
  return parts;
}

Parts take_apart(const Eigen::MatrixXd& scaled, double limit_share) {
  constexpr Eigen::Index kMany = 200;  // an eigen-decomposition of fewer takes no time
  if (scaled.rows() > kMany)
    if (auto parts = by_pivots(scaled, limit_share)) return *parts;
  return by_eigenvectors(scaled, limit_share);
}

}  // namespace

Observability observe(const Eigen::MatrixXd& normal, double cutoff) {
  const Eigen::Index n = normal.rows();
  Observability result;
  result.covariance = Eigen::MatrixXd::Zero(n, n);
  result.determined.assign(static_cast<std::size_t>(n), 1);
  if (n == 0) return result;
  const Eigen::VectorXd scale = unit_scale(normal);
  const Parts parts = take_apart(scale.asDiagonal() * normal * scale.asDiagonal(), cutoff * cutoff);
  result.rank = parts.rank;
  if (parts.rank > 0) {
    result.condition = std::sqrt(parts.largest / parts.weak_squares[0]);
    result.covariance = scale.asDiagonal() * parts.inverse * scale.asDiagonal();
  }
  for (Eigen::Index k = 0; k < parts.weak.cols(); ++k)
    result.weakest.push_back(
        {std::sqrt(parts.weak_squares[k] / parts.largest), parts_of(parts.weak.col(k), kWeakShare)});
  if (parts.unseen.cols() == 0) return result;
  for (Eigen::Index i = 0; i < n; ++i)
    if (parts.unseen.row(i).norm() > kDeterminedShare) result.determined[static_cast<std::size_t>(i)] = 0;
  result.unidentifiable = name_parts(parts.unseen.transpose());
  return result;
}

}  // namespace vernier::fit
