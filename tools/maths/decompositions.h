// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Solvers for systems of equations, and decompositions of matrices of dynamic size. The solvers are compiled
// once in this folder, because each instantiation in another folder would need seconds of compile time.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace vernier::maths {

namespace compiled {
using Eigen::MatrixXd;
using Eigen::VectorXd;
VectorXd least_squares(const MatrixXd& a, const VectorXd& b);
MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b);
VectorXd least_norm(const MatrixXd& a, const VectorXd& b);
MatrixXd least_norm(const MatrixXd& a, const MatrixXd& b);
VectorXd solve_positive(const MatrixXd& a, const VectorXd& b);
MatrixXd solve_positive(const MatrixXd& a, const MatrixXd& b);
VectorXd solve_symmetric(const MatrixXd& a, const VectorXd& b);
MatrixXd solve_symmetric(const MatrixXd& a, const MatrixXd& b);
}  // namespace compiled

/// Type of a solution: a vector if the right side is a vector, and a matrix if it is a matrix.
template <class Right>
using Solution = Eigen::Matrix<double, Eigen::Dynamic, Right::ColsAtCompileTime == 1 ? 1 : Eigen::Dynamic>;

/// Returns the x that minimises |a x - b|. `a`: n x p, of rank p. The method is Householder QR with column
/// pivoting.
template <class Right>
Solution<Right> least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixBase<Right>& b) {
  return compiled::least_squares(a, Solution<Right>(b));
}
/// Returns the shortest x that minimises |a x - b|. `a`: any rank. The method is a complete orthogonal
/// decomposition.
template <class Right>
Solution<Right> least_norm(const Eigen::MatrixXd& a, const Eigen::MatrixBase<Right>& b) {
  return compiled::least_norm(a, Solution<Right>(b));
}
/// Returns the solution x of a x = b for a symmetric, positive definite matrix a. The method is a Cholesky
/// decomposition.
template <class Right>
Solution<Right> solve_positive(const Eigen::MatrixXd& a, const Eigen::MatrixBase<Right>& b) {
  return compiled::solve_positive(a, Solution<Right>(b));
}
/// Returns the solution x of a x = b for a symmetric matrix a that is positive semidefinite except for
/// rounding. The method is a Cholesky decomposition with pivots.
template <class Right>
Solution<Right> solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixBase<Right>& b) {
  return compiled::solve_symmetric(a, Solution<Right>(b));
}
/// Returns the solution x of a x = b for a square, regular matrix a. The method is Gauss elimination with row
/// pivots.
Eigen::MatrixXd solve_square(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Returns an orthonormal basis, n x rank, of the column space of a. A column that depends on other columns,
/// within `threshold` of the largest pivot, is excluded (0: the rounding limit of the library). The method is
/// Householder QR with column pivoting.
Eigen::MatrixXd range_of(const Eigen::MatrixXd& a, double threshold = 0);
/// Returns the first p <= n columns of Q in a = Q R, for any rank: n x p, orthonormal.
Eigen::MatrixXd thin_q(const Eigen::MatrixXd& a);

}  // namespace vernier::maths

namespace Eigen {
extern template class LLT<MatrixXd>;
extern template class LDLT<MatrixXd>;
extern template class ColPivHouseholderQR<MatrixXd>;
extern template class CompleteOrthogonalDecomposition<MatrixXd>;
extern template class SelfAdjointEigenSolver<MatrixXd>;
extern template class JacobiSVD<MatrixXd>;
}  // namespace Eigen
