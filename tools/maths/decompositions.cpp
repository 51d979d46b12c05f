// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/decompositions.h"

#include <Eigen/LU>

namespace Eigen {
template class LLT<MatrixXd>;
template class LDLT<MatrixXd>;
template class ColPivHouseholderQR<MatrixXd>;
template class CompleteOrthogonalDecomposition<MatrixXd>;
template class SelfAdjointEigenSolver<MatrixXd>;
template class JacobiSVD<MatrixXd>;
}  // namespace Eigen

namespace vernier::maths {

namespace compiled {

VectorXd least_squares(const MatrixXd& a, const VectorXd& b) { return a.colPivHouseholderQr().solve(b); }
MatrixXd least_squares(const MatrixXd& a, const MatrixXd& b) { return a.colPivHouseholderQr().solve(b); }
VectorXd least_norm(const MatrixXd& a, const VectorXd& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}
MatrixXd least_norm(const MatrixXd& a, const MatrixXd& b) {
  return a.completeOrthogonalDecomposition().solve(b);
}
VectorXd solve_positive(const MatrixXd& a, const VectorXd& b) { return a.llt().solve(b); }
MatrixXd solve_positive(const MatrixXd& a, const MatrixXd& b) { return a.llt().solve(b); }
VectorXd solve_symmetric(const MatrixXd& a, const VectorXd& b) { return a.ldlt().solve(b); }
MatrixXd solve_symmetric(const MatrixXd& a, const MatrixXd& b) { return a.ldlt().solve(b); }

}  // namespace compiled

Eigen::MatrixXd solve_square(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.partialPivLu().solve(b);
}

Eigen::MatrixXd range_of(const Eigen::MatrixXd& a, double threshold) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
  if (threshold > 0) qr.setThreshold(threshold);
  return qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), qr.rank());
}

Eigen::MatrixXd thin_q(const Eigen::MatrixXd& a) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  return qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), a.cols());
}

}  // namespace vernier::maths
