// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/pivoted_cholesky.h"

#include <Eigen/QR>
#include <cmath>
#include <numeric>

#include "tools/maths/inverse.h"

namespace vernier::maths {
namespace {

using Eigen::Index;
constexpr Index kPanel = 48;  // columns; a panel of 2000 rows stays in a second-level cache

}  // namespace

PivotedCholesky::PivotedCholesky(Eigen::MatrixXd matrix, double cutoff, const std::vector<char>& held)
    : lower_(std::move(matrix)), order_(static_cast<std::size_t>(lower_.rows())), rank_(lower_.rows()) {
  const Index n = lower_.rows();
  std::iota(order_.begin(), order_.end(), 0);
  if (n == 0) return;
  const double least = cutoff * std::max(lower_.diagonal().maxCoeff(), 1e-300);
  for (Index first = 0; first < rank_; first += kPanel) {
    const Index end = std::min(first + kPanel, n);
    factor_panel(first, end, least, held);
    const Index done = std::min(end, rank_), rest = n - done;
    if (done < end || rest == 0) break;
    lower_.bottomRightCorner(rest, rest)
        .selfadjointView<Eigen::Lower>()
        .rankUpdate(lower_.block(done, first, rest, done - first), -1);
  }
}

void PivotedCholesky::factor_panel(Index first, Index end, double least, const std::vector<char>& held) {
  const Index n = lower_.rows();
  seen_.setZero(n);
  for (Index j = first; j < end; ++j) {
    Index best = -1;
    double most = least;
    for (Index i = j; i < n; ++i) {
      if (j > first) seen_[i] += lower_(i, j - 1) * lower_(i, j - 1);
      const double remains = lower_(i, i) - seen_[i];
      if (!(remains > most)) continue;
      if (!held.empty() && held[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])] != 0) continue;
      most = remains;
      best = i;
    }
    if (best < 0) {
      rank_ = j;
      return;
    }
    if (best != j) swap(j, best);
    const double root = std::sqrt(most);
    lower_(j, j) = root;
    const Index below = n - j - 1, width = j - first;
    auto column = lower_.col(j).tail(below);
    if (width > 0)
      column.noalias() -=
          lower_.block(j + 1, first, below, width) * lower_.row(j).segment(first, width).transpose();
    column /= root;
  }
}

/// Rows and columns a < b change places in the lower triangle.
void PivotedCholesky::swap(Index a, Index b) {
  const Index n = lower_.rows();
  std::swap(order_[static_cast<std::size_t>(a)], order_[static_cast<std::size_t>(b)]);
  std::swap(seen_[a], seen_[b]);
  std::swap(lower_(a, a), lower_(b, b));
  lower_.row(a).head(a).swap(lower_.row(b).head(a));
  for (Index i = a + 1; i < b; ++i) std::swap(lower_(i, a), lower_(b, i));
  if (b + 1 < n) lower_.col(a).tail(n - b - 1).swap(lower_.col(b).tail(n - b - 1));
}

Eigen::VectorXd PivotedCholesky::solve(const Eigen::VectorXd& right) const { return solve_many(right); }

Eigen::MatrixXd PivotedCholesky::solve_many(const Eigen::MatrixXd& right) const {
  Eigen::MatrixXd kept(rank_, right.cols());
  for (Index i = 0; i < rank_; ++i) kept.row(i) = right.row(order_[static_cast<std::size_t>(i)]);
  const auto factor = lower_.topLeftCorner(rank_, rank_).triangularView<Eigen::Lower>();
  factor.solveInPlace(kept);
  factor.adjoint().solveInPlace(kept);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(right.rows(), right.cols());
  for (Index i = 0; i < rank_; ++i) result.row(order_[static_cast<std::size_t>(i)]) = kept.row(i);
  return result;
}

std::vector<char> PivotedCholesky::left_over() const {
  std::vector<char> left(order_.size(), 0);
  for (std::size_t i = static_cast<std::size_t>(rank_); i < order_.size(); ++i)
    left[static_cast<std::size_t>(order_[i])] = 1;
  return left;
}

Eigen::MatrixXd PivotedCholesky::null_basis() const {
  const Index n = lower_.rows(), lost = n - rank_;
  if (lost == 0) return Eigen::MatrixXd(n, 0);
  Eigen::MatrixXd permuted(n, lost);
  permuted.topRows(rank_) = -lower_.bottomLeftCorner(lost, rank_).transpose();
  lower_.topLeftCorner(rank_, rank_)
      .triangularView<Eigen::Lower>()
      .adjoint()
      .solveInPlace(permuted.topRows(rank_));
  permuted.bottomRows(lost).setIdentity();
  Eigen::MatrixXd basis(n, lost);
  for (Index i = 0; i < n; ++i) basis.row(order_[static_cast<std::size_t>(i)]) = permuted.row(i);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(basis);
  return qr.householderQ() * Eigen::MatrixXd::Identity(n, lost);
}

Eigen::MatrixXd PivotedCholesky::inverse() const {
  const Index n = lower_.rows();
  Eigen::MatrixXd root = lower_.topLeftCorner(rank_, rank_);
  invert_lower(root);
  const Eigen::MatrixXd kept = square_of_lower(root);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (Index k = 0; k < rank_; ++k)
    for (Index i = 0; i < rank_; ++i)
      result(order_[static_cast<std::size_t>(i)], order_[static_cast<std::size_t>(k)]) = kept(i, k);
  return result;
}

}  // namespace vernier::maths
