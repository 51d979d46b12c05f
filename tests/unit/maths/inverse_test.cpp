// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/inverse.h"

#include <gtest/gtest.h>

#include <random>

namespace vernier::inverse_test {

using namespace vernier::maths;
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr unsigned kSeed = 5;

MatrixXd some(Index rows, Index columns) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal(0, 1);
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

MatrixXd positive(Index n) {
  const MatrixXd rows = some(2 * n + 3, n);
  return rows.transpose() * rows / static_cast<double>(n);
}

class InverseOf : public testing::TestWithParam<int> {};

/// Sizes around one and two blocks of 64.
TEST_P(InverseOf, PositiveMatrixTimesTheMatrixIsOne) {
  const Index n = GetParam();
  MatrixXd matrix = positive(n);
  const MatrixXd whole = matrix;
  matrix.triangularView<Eigen::StrictlyUpper>().setConstant(7);  // not read
  const auto inverse = inverse_of_positive(matrix);
  ASSERT_TRUE(inverse);
  EXPECT_LT((*inverse * whole - MatrixXd::Identity(n, n)).norm(), 1e-10);
  EXPECT_EQ((*inverse - inverse->transpose()).norm(), 0);
}

TEST_P(InverseOf, LowerTriangleLeavesTheUpperOneAlone) {
  const Index n = GetParam();
  MatrixXd lower = some(n, n);
  lower.diagonal().array() = 2 + lower.diagonal().array().abs();
  lower.triangularView<Eigen::StrictlyLower>() = 0.1 * lower;
  const MatrixXd before = lower;
  invert_lower(lower);
  const MatrixXd product =
      MatrixXd(lower.triangularView<Eigen::Lower>()) * MatrixXd(before.triangularView<Eigen::Lower>());
  EXPECT_LT((product - MatrixXd::Identity(n, n)).norm(),
            1e-9 * (1 + lower.triangularView<Eigen::Lower>().toDenseMatrix().norm()));
  EXPECT_EQ((MatrixXd(lower.triangularView<Eigen::StrictlyUpper>()) -
             MatrixXd(before.triangularView<Eigen::StrictlyUpper>()))
                .norm(),
            0);
}

TEST_P(InverseOf, SymmetricProductIsTheProduct) {
  const Index n = GetParam();
  const MatrixXd a = positive(n), b = a * a + MatrixXd::Identity(n, n);
  EXPECT_LT((symmetric_product(a, b) - a * b).norm(), 1e-12 * (a * b).norm());
}

INSTANTIATE_TEST_SUITE_P(Sizes, InverseOf, testing::Values(1, 2, 63, 64, 65, 130, 200));

TEST(InverseOfPositive, AnIndefiniteMatrixHasNone) {
  MatrixXd matrix = positive(70);
  matrix(69, 69) = -1;
  EXPECT_FALSE(inverse_of_positive(matrix));
}

}  // namespace
}  // namespace vernier::inverse_test
