// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

namespace vernier::maths {

/// Cholesky factor L L^T of a positive semidefinite matrix, for the rows and columns that do not (nearly)
/// depend on the others. The method is diagonal pivoting block by block (Lucas, LAPACK-style codes for level
/// 2 and 3 pivoted Cholesky factorizations, LAPACK working note 161). The remaining columns define the null
/// space of the matrix, which is reported and not damped.
class PivotedCholesky {
 public:
  /// `matrix`: n x n, with diagonal elements of about 1. Only the lower triangle of the matrix is read. A
  /// column depends on earlier columns if its remaining square is below `cutoff` times the largest diagonal
  /// element. `held`: columns that must not be pivots. If `held` is empty, all columns may be pivots.
  PivotedCholesky(Eigen::MatrixXd matrix, double cutoff, const std::vector<char>& held = {});

  Eigen::Index rank() const { return rank_; }
  /// Returns the solution of the equations, with zeros for the columns that are not pivots.
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd solve_many(const Eigen::MatrixXd& right) const;
  /// Returns flags of the columns that are not pivots.
  std::vector<char> left_over() const;
  /// Returns orthonormal directions that the pivot rows do not determine, n x (n - rank).
  Eigen::MatrixXd null_basis() const;
  /// Returns the inverse for the pivot rows and columns. All other rows and columns are zero.
  Eigen::MatrixXd inverse() const;

 private:
  void factor_panel(Eigen::Index first, Eigen::Index end, double least, const std::vector<char>& held);
  void swap(Eigen::Index a, Eigen::Index b);

  Eigen::MatrixXd lower_;            // the factor L, with permuted rows
  std::vector<Eigen::Index> order_;  // position -> column of the matrix
  Eigen::VectorXd seen_;             // sum of squares of each row within the panel
  Eigen::Index rank_ = 0;
};

}  // namespace vernier::maths
