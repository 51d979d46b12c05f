// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/least_squares/levenberg.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace vernier::levenberg_test {

using namespace vernier::fit;
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Residuals and their derivatives as a problem of the solver.
struct Problem {
  std::function<VectorXd(const VectorXd&)> residual;  // measured - predicted
  std::function<MatrixXd(const VectorXd&)> jacobian;  // of predicted
  int equations_asked = 0;

  LevenbergResult solve(const VectorXd& start, LevenbergOptions options = {}, bool with_slope = true) {
    if (with_slope)
      options.slope = [this](const VectorXd& x) {
        return Slope{residual(x).squaredNorm(), jacobian(x).transpose() * residual(x)};
      };
    return minimise(
        start,
        [this](const VectorXd& x) {
          ++equations_asked;
          const MatrixXd j = jacobian(x);
          return NormalEquations{residual(x).squaredNorm(), j.transpose() * j, j.transpose() * residual(x)};
        },
        [this](const VectorXd& x) { return residual(x).squaredNorm(); }, options);
  }
};

/// Rosenbrock's valley, as residuals.
Problem valley() {
  return {[](const VectorXd& x) {
            return VectorXd{{1 - x[0], -10 * (x[1] - x[0] * x[0])}};
          },
          [](const VectorXd& x) {
            return MatrixXd{{1, 0}, {-20 * x[0], 10}};
          }};
}

TEST(Levenberg, FollowsACurvedValley) {
  for (const bool with_slope : {true, false}) {
    const LevenbergResult result = valley().solve(VectorXd{{-1.2, 1}}, {}, with_slope);
    EXPECT_TRUE(result.converged);
    EXPECT_LT((result.point - VectorXd{{1, 1}}).norm(), 1e-6);
  }
}

TEST(Levenberg, ChordStepsSaveNormalEquations) {
  // Nearly linear: four readings of x + 0.01 x^2.
  Problem problem{[](const VectorXd& x) {
                    return VectorXd{VectorXd::LinSpaced(4, 0.9, 1.2).array() - x[0] - 0.01 * x[0] * x[0]};
                  },
                  [](const VectorXd& x) { return MatrixXd::Constant(4, 1, 1 + 0.02 * x[0]); }};
  LevenbergOptions options;
  options.negligible = [](double cost) { return 1e-9 * cost; };
  const LevenbergResult with = problem.solve(VectorXd::Zero(1), options);
  const int asked = problem.equations_asked;
  problem.equations_asked = 0;
  const LevenbergResult without = problem.solve(VectorXd::Zero(1), options, false);
  EXPECT_NEAR(with.cost, without.cost, 1e-8 * without.cost);
  EXPECT_LT(asked, problem.equations_asked);
}

TEST(Levenberg, LeavesAnUnseenDirectionAtItsStart) {
  Problem problem{[](const VectorXd& x) {
                    return VectorXd{{3 - x[0] - x[1], 1 - 2 * x[0] - 2 * x[1]}};
                  },
                  [](const VectorXd&) {
                    return MatrixXd{{1, 1}, {2, 2}};
                  }};
  const LevenbergResult result = problem.solve(VectorXd{{0.5, -0.5}});
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.point[0] - result.point[1], 1, 1e-12);
  EXPECT_EQ(std::count(result.held.begin(), result.held.end(), 1), 1);
}

}  // namespace
}  // namespace vernier::levenberg_test
