#include "tools/fit/observability.h"

#include <gtest/gtest.h>

namespace vernier {
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

}  // namespace
}  // namespace vernier
