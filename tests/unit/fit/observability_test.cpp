// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/least_squares/observability.h"

#include <gtest/gtest.h>

#include <set>

#include "tools/maths/decompositions.h"

namespace vernier::observability_test {

using namespace vernier::fit;
namespace {

TEST(Observability, NamesTheCombinationThatTheDataCannotSee) {
  Eigen::MatrixXd jacobian(50, 4);
  for (Eigen::Index i = 0; i < 50; ++i) {
    const double x = static_cast<double>(i) / 10;
    jacobian.row(i) << 1, x, 1e-3 * x, x * x;  // the second and third are one column in other units
  }
  const Observability seen = observe(jacobian.transpose() * jacobian);
  EXPECT_EQ(seen.rank, 3);
  ASSERT_EQ(seen.unidentifiable.size(), 1U);
  EXPECT_EQ(seen.unidentifiable[0].size(), 2U);
  EXPECT_TRUE(seen.determined[0] && seen.determined[3]);
  EXPECT_FALSE(seen.determined[1] || seen.determined[2]);
}

TEST(Observability, NamesAParameterWithoutEffect) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(3, 3);
  normal(1, 1) = 0;
  const Observability seen = observe(normal);
  EXPECT_EQ(seen.rank, 2);
  EXPECT_EQ(seen.unidentifiable, (std::vector<std::vector<std::size_t>>{{1}}));
}

TEST(Observability, SeparatesTwoCombinations) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Random(30, 5);
  jacobian.col(1) = 2 * jacobian.col(0);
  jacobian.col(4) = jacobian.col(2) - jacobian.col(3);
  const Observability seen = observe(jacobian.transpose() * jacobian);
  EXPECT_EQ(seen.rank, 3);
  ASSERT_EQ(seen.unidentifiable.size(), 2U);
  EXPECT_EQ(seen.unidentifiable[0].size() + seen.unidentifiable[1].size(), 5U);
}

TEST(Observability, CovarianceIsThatOfTheNormalMatrix) {
  const Eigen::MatrixXd jacobian = Eigen::MatrixXd::Random(30, 4);
  const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
  EXPECT_LT((observe(normal).covariance * normal - Eigen::MatrixXd::Identity(4, 4)).norm(), 1e-9);
}

/// A survey-like matrix of more parameters than the eigenvectors take on: the same findings both ways.
TEST(Observability, ManyParametersFindWhatEigenvectorsFind) {
  constexpr Eigen::Index kMany = 230;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Random(500, kMany);
  jacobian.col(7) = 2 * jacobian.col(3) - jacobian.col(200);
  jacobian.col(229) = jacobian.col(100) + 1e-3 * Eigen::VectorXd::Random(500);  // weak, yet seen
  jacobian.col(50) *= 1e4;                                                      // another unit
  const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
  const Observability seen = observe(normal);
  EXPECT_EQ(seen.rank, kMany - 1);
  ASSERT_EQ(seen.unidentifiable.size(), 1U);
  EXPECT_EQ(std::set<std::size_t>(seen.unidentifiable[0].begin(), seen.unidentifiable[0].end()),
            (std::set<std::size_t>{3, 7, 200}));
  EXPECT_FALSE(seen.determined[3] || seen.determined[7] || seen.determined[200]);
  EXPECT_TRUE(seen.determined[100] && seen.determined[229]);
  ASSERT_EQ(seen.weakest.size(), 3U);
  EXPECT_EQ(std::set<std::size_t>(seen.weakest[0].parts.begin(), seen.weakest[0].parts.end()),
            (std::set<std::size_t>{100, 229}));
  const Eigen::VectorXd length = normal.diagonal().cwiseSqrt();
  const Eigen::MatrixXd scaled =
      length.cwiseInverse().asDiagonal() * normal * length.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  const double condition = std::sqrt(eigen.eigenvalues()[kMany - 1] / eigen.eigenvalues()[1]);
  EXPECT_NEAR(seen.condition, condition, 0.03 * condition);
  // N C N = N for a generalised inverse, and C is the shortest of them.
  EXPECT_LT((normal * seen.covariance * normal - normal).norm(), 1e-8 * normal.norm());
  const Eigen::MatrixXd inverse = length.asDiagonal() * seen.covariance * length.asDiagonal();
  EXPECT_LT((inverse * eigen.eigenvectors().col(0)).norm(), 1e-8 * inverse.norm());
}

/// Directions just below the limit beside others just above it: as the eigenvectors tell.
TEST(Observability, ManyParametersWithDirectionsOnBothSidesOfTheLimit) {
  constexpr Eigen::Index kMany = 240;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Random(500, kMany);
  for (const auto& [k, times] :
       {std::pair(20, 0.3), std::pair(70, 0.1), std::pair(120, 5.0), std::pair(180, 30.0)})
    jacobian.col(k) = jacobian.col(k + 1) + times * kUnseenShare * Eigen::VectorXd::Random(500) * 10;
  const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
  const Eigen::VectorXd length = normal.diagonal().cwiseSqrt();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(length.cwiseInverse().asDiagonal() * normal *
                                                             length.cwiseInverse().asDiagonal());
  const Eigen::VectorXd& squares = eigen.eigenvalues();
  const auto lost = (squares.array() < kUnseenShare * kUnseenShare * squares[kMany - 1]).count();
  ASSERT_GT(lost, 0);
  ASSERT_LT(lost, 4);
  const Observability seen = observe(normal);
  EXPECT_EQ(seen.rank, kMany - lost);
  EXPECT_EQ(seen.unidentifiable.size(), static_cast<std::size_t>(lost));
  const Eigen::MatrixXd kept = eigen.eigenvectors().rightCols(kMany - lost);
  const Eigen::MatrixXd expected =
      kept * squares.tail(kMany - lost).cwiseInverse().asDiagonal() * kept.transpose();
  const Eigen::MatrixXd inverse = length.asDiagonal() * seen.covariance * length.asDiagonal();
  EXPECT_LT((inverse - expected).norm(), 1e-3 * expected.norm());
  EXPECT_NEAR(seen.condition, std::sqrt(squares[kMany - 1] / squares[lost]), 0.03 * seen.condition);
}

TEST(Observability, NamesTheWeakestDirectionThatIsStillSeen) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Random(40, 5);
  jacobian.col(4) = jacobian.col(1) + 1e-3 * jacobian.col(4);
  const Observability seen = observe(jacobian.transpose() * jacobian);
  ASSERT_EQ(seen.weakest.size(), 3U);
  EXPECT_LT(seen.weakest[0].ratio, 2e-3);
  EXPECT_EQ(std::set<std::size_t>(seen.weakest[0].parts.begin(), seen.weakest[0].parts.end()),
            (std::set<std::size_t>{1, 4}));
}

}  // namespace
}  // namespace vernier::observability_test
