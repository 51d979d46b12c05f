// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/inverse.h"

#include <algorithm>

#include "tools/maths/decompositions.h"

namespace vernier::maths {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kBlock = 64;  // rows; a block of 2000 columns stays in a second-level cache

void mirror(MatrixXd& matrix) { matrix.triangularView<Eigen::StrictlyUpper>() = matrix.transpose(); }

}  // namespace

void invert_lower(Eigen::Ref<MatrixXd> lower) {
  const Index n = lower.rows();
  for (Index end = n; end > 0;) {
    const Index size = (end - 1) % kBlock + 1, first = end - size, below = n - end;
    MatrixXd corner = MatrixXd::Identity(size, size);
    lower.block(first, first, size, size).triangularView<Eigen::Lower>().solveInPlace(corner);
    if (below > 0) {
      const MatrixXd beside = lower.bottomRightCorner(below, below).triangularView<Eigen::Lower>() *
                              lower.block(end, first, below, size);
      lower.block(end, first, below, size).noalias() = -beside * corner;
    }
    lower.block(first, first, size, size).triangularView<Eigen::Lower>() = corner;
    end = first;
  }
}

MatrixXd square_of_lower(const Eigen::Ref<const MatrixXd>& lower) {
  const Index n = lower.rows();
  MatrixXd square = MatrixXd::Zero(n, n);
  for (Index first = 0; first < n; first += kBlock) {
    const Index end = std::min(first + kBlock, n);
    MatrixXd rows = lower.block(first, 0, end - first, end);
    rows.rightCols(end - first).triangularView<Eigen::StrictlyUpper>().setZero();
    square.topLeftCorner(end, end).selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  }
  mirror(square);
  return square;
}

std::optional<MatrixXd> inverse_of_positive(const MatrixXd& matrix) {
  const Eigen::LLT<MatrixXd> llt(matrix);
  if (llt.info() != Eigen::Success) return std::nullopt;
  MatrixXd root = llt.matrixLLT();
  invert_lower(root);
  return square_of_lower(root);
}

MatrixXd symmetric_product(const MatrixXd& a, const MatrixXd& b) {
  MatrixXd product(a.rows(), b.cols());
  product.triangularView<Eigen::Lower>() = a * b;
  mirror(product);
  return product;
}

}  // namespace vernier::maths
