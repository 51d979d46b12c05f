// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/pivoted_cholesky.h"

#include <gtest/gtest.h>

#include <random>

namespace vernier::pivoted_cholesky_test {

using namespace vernier::maths;
namespace {

using Eigen::MatrixXd;

constexpr unsigned kSeed = 3;

/// n x n of rank r, unit diagonal.
MatrixXd semidefinite(Eigen::Index n, Eigen::Index r) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal(0, 1);
  MatrixXd rows = MatrixXd::NullaryExpr(r, n, [&] { return normal(random); });
  rows.colwise().normalize();
  return rows.transpose() * rows;
}

class PivotedCholeskyOf : public testing::TestWithParam<std::pair<int, int>> {};

/// Sizes around the panel of 48 and the rank within, at the end of and beyond the first panel.
TEST_P(PivotedCholeskyOf, SolvesOnTheKeptPartAndNamesTheRest) {
  const auto [n, r] = GetParam();
  const MatrixXd matrix = semidefinite(n, r);
  const PivotedCholesky factor(matrix, 1e-10);
  ASSERT_EQ(factor.rank(), r);
  const Eigen::VectorXd right = matrix * Eigen::VectorXd::LinSpaced(n, -1, 2);
  // The condition of such a matrix is below 1e6.
  EXPECT_LT((matrix * factor.solve(right) - right).norm(), 1e-8 * right.norm());
  const MatrixXd unseen = factor.null_basis();
  ASSERT_EQ(unseen.cols(), n - r);
  EXPECT_LT((matrix * unseen).norm(), 1e-8);
  EXPECT_LT((unseen.transpose() * unseen - MatrixXd::Identity(n - r, n - r)).norm(), 1e-12);
  EXPECT_LT((factor.inverse() * right - factor.solve(right)).norm(), 1e-8 * factor.solve(right).norm());
}

INSTANTIATE_TEST_SUITE_P(Sizes, PivotedCholeskyOf,
                         testing::Values(std::pair{1, 1}, std::pair{20, 20}, std::pair{48, 48},
                                         std::pair{49, 49}, std::pair{60, 30}, std::pair{96, 48},
                                         std::pair{130, 97}));

TEST(PivotedCholesky, NeverTakesAHeldColumn) {
  std::vector<char> held(10, 0);
  held[0] = held[7] = 1;
  const PivotedCholesky factor(semidefinite(10, 10), 1e-10, held);
  EXPECT_EQ(factor.rank(), 8);
  EXPECT_EQ(factor.left_over(), held);
}

TEST(PivotedCholesky, OfZeroHasNoRank) {
  const PivotedCholesky factor(MatrixXd::Zero(3, 3), 1e-10);
  EXPECT_EQ(factor.rank(), 0);
  EXPECT_EQ(factor.null_basis().cols(), 3);
  EXPECT_EQ(factor.solve(Eigen::VectorXd::Ones(3)), Eigen::VectorXd::Zero(3));
}

}  // namespace
}  // namespace vernier::pivoted_cholesky_test
