// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

namespace vernier::maths {

/// Factor L L^T of a positive semidefinite matrix, for the rows and columns that are not (nearly) dependent
/// on the others. Diagonal pivoting, block by block (Lucas, LAPACK-style codes for level 2 and 3 pivoted
/// Cholesky factorizations, LAPACK working note 161). The remaining columns define the null space, which is
/// reported and not damped.
class PivotedCholesky {
 public:
  /// matrix: n x n, the lower triangle is read; the diagonal of the matrix is about 1. A column depends on
  /// earlier columns if its remaining square is below `cutoff` times the largest diagonal. `held`: columns
  /// that must not be pivots (empty: all columns may be pivots).
  PivotedCholesky(Eigen::MatrixXd matrix, double cutoff, const std::vector<char>& held = {});

  Eigen::Index rank() const { return rank_; }
  /// Returns the solution with zeros at the remaining columns.
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd solve_many(const Eigen::MatrixXd& right) const;
  /// Returns the remaining columns.
  std::vector<char> left_over() const;
  /// Returns n x (n - rank), orthonormal: directions that the pivot rows do not determine.
  Eigen::MatrixXd null_basis() const;
  /// Returns the inverse of the pivot rows and columns, and zero in all other rows and columns.
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
