// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Systems of equations and decompositions of matrices of dynamic size. They are compiled once
// here, because each instantiation in another folder would need seconds of compile time.
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

/// The result is a vector for a vector, a matrix for a matrix.
template <class Right>
using Solution = Eigen::Matrix<double, Eigen::Dynamic, Right::ColsAtCompileTime == 1 ? 1 : Eigen::Dynamic>;

/// Returns x of least |a x - b|; a: n x p of rank p. Householder QR with column pivoting.
template <class Right>
Solution<Right> least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixBase<Right>& b) {
  return compiled::least_squares(a, Solution<Right>(b));
}
/// Returns the shortest x of least |a x - b|; a of any rank. Complete orthogonal decomposition.
template <class Right>
Solution<Right> least_norm(const Eigen::MatrixXd& a, const Eigen::MatrixBase<Right>& b) {
  return compiled::least_norm(a, Solution<Right>(b));
}
/// Returns x of a x = b; a symmetric, positive definite. Cholesky.
template <class Right>
Solution<Right> solve_positive(const Eigen::MatrixXd& a, const Eigen::MatrixBase<Right>& b) {
  return compiled::solve_positive(a, Solution<Right>(b));
}
/// Returns x of a x = b; a symmetric and, except for rounding, positive semidefinite. Cholesky
/// with pivots.
template <class Right>
Solution<Right> solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixBase<Right>& b) {
  return compiled::solve_symmetric(a, Solution<Right>(b));
}
/// Returns x of a x = b; a square and regular. Gauss with row pivots.
Eigen::MatrixXd solve_square(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Returns an orthonormal basis, n x rank, of the range of a. Columns that depend on other columns to
/// `threshold` of the largest pivot are excluded (0: the limit of the library, rounding). Householder QR with
/// column pivoting.
Eigen::MatrixXd range_of(const Eigen::MatrixXd& a, double threshold = 0);
/// Returns n x p, orthonormal: the first p <= n columns of Q of a = Q R, for any rank.
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
