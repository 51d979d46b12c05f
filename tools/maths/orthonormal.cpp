// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/orthonormal.h"

namespace vernier::maths {

Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns, double least, std::vector<std::size_t>* kept) {
  Eigen::MatrixXd basis(columns.rows(), columns.cols());
  Eigen::Index count = 0;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    Eigen::VectorXd column = columns.col(j);
    const double before = column.norm();
    if (before == 0) continue;
    for (int pass = 0; pass < 2; ++pass)
      column -= basis.leftCols(count) * (basis.leftCols(count).transpose() * column);
    const double after = column.norm();
    if (after < least * before) continue;
    basis.col(count++) = column / after;
    if (kept != nullptr) kept->push_back(static_cast<std::size_t>(j));
  }
  return basis.leftCols(count);
}

Eigen::MatrixXd side_by_side(Eigen::Index rows, const std::vector<Eigen::MatrixXd>& parts) {
  Eigen::Index count = 0;
  for (const Eigen::MatrixXd& part : parts) count += part.cols();
  Eigen::MatrixXd all(rows, count);
  Eigen::Index at = 0;
  for (const Eigen::MatrixXd& part : parts) {
    all.middleCols(at, part.cols()) = part;
    at += part.cols();
  }
  return all;
}

}  // namespace vernier::maths
