// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

namespace vernier::maths {

/// L L^T of the rows and columns of a positive semidefinite matrix that are not (nearly) dependent
/// on the others: diagonal pivoting, block by block (Lucas, LAPACK-style codes for level 2 and 3
/// pivoted Cholesky factorizations, LAPACK working note 161). The remaining columns define the
/// null space, which is reported and not damped. tool.
class PivotedCholesky {
 public:
  /// matrix: n x n, the lower triangle is read; its diagonal is about 1. A column whose remaining
  /// square is below `cutoff` times the largest diagonal depends on earlier columns. `held`:
  /// columns that may not be pivots (empty: all may).
  PivotedCholesky(Eigen::MatrixXd matrix, double cutoff, const std::vector<char>& held = {});

  Eigen::Index rank() const { return rank_; }
  /// Returns the solution with zeros at the remaining columns.
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd solve_many(const Eigen::MatrixXd& right) const;
  /// Returns the remaining columns.
  std::vector<char> left_over() const;
  /// n x (n - rank), orthonormal: directions that the kept rows do not determine.
  Eigen::MatrixXd null_basis() const;
  /// Inverse over the kept rows and columns, zero elsewhere.
  Eigen::MatrixXd inverse() const;

 private:
  void factor_panel(Eigen::Index first, Eigen::Index end, double least, const std::vector<char>& held);
  void swap(Eigen::Index a, Eigen::Index b);

  Eigen::MatrixXd lower_;            // L, permuted
  std::vector<Eigen::Index> order_;  // position -> column of the matrix
  Eigen::VectorXd seen_;             // squares of the row within the panel
  Eigen::Index rank_ = 0;
};

}  // namespace vernier::maths
