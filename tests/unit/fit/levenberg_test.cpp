#include "tools/fit/levenberg.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace vernier {
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

/// y = a (1 - exp(-t / b)): nothing is seen of b while a is zero.
Problem saturation(double a, double b, double noise) {
  const VectorXd t = VectorXd::LinSpaced(40, 0, 10);
  VectorXd y(40);
  for (Eigen::Index i = 0; i < 40; ++i) y[i] = a * (1 - std::exp(-t[i] / b)) + (i % 2 == 0 ? noise : -noise);
  return {[=](const VectorXd& x) { return VectorXd{y.array() - x[0] * (1 - (-t.array() / x[1]).exp())}; },
          [=](const VectorXd& x) {
            MatrixXd j(40, 2);
            j.col(0) = 1 - (-t.array() / x[1]).exp();
            j.col(1) = -x[0] * t.array() / (x[1] * x[1]) * (-t.array() / x[1]).exp();
            return j;
          }};
}

LevenbergOptions judged_by_chance() {
  LevenbergOptions options;
  options.negligible = [](double cost) { return 1e-9 * cost; };
  options.chance = [](double cost) { return cost / 38; };
  return options;
}

TEST(Levenberg, ReleasesADirectionThatShowsOnTheWay) {
  const LevenbergResult result = saturation(2, 3, 0.01).solve(VectorXd{{0, 5}}, judged_by_chance());
  EXPECT_TRUE(result.converged);
  // The noise alternates and so hardly leans on either: a hundredth of it over sqrt(40).
  EXPECT_NEAR(result.point[0], 2, 0.01);
  EXPECT_NEAR(result.point[1], 3, 0.03);
  EXPECT_EQ(std::count(result.held.begin(), result.held.end(), 1), 0);
}

/// A start that is right is no reason to call a parameter unseen once the data see it plainly.
TEST(Levenberg, ReleasesWhatIsPlainlySeenThoughTheStartWasRight) {
  const LevenbergResult result = saturation(2, 3, 0.01).solve(VectorXd{{0, 3}}, judged_by_chance());
  EXPECT_EQ(std::count(result.held.begin(), result.held.end(), 1), 0);
}

/// Readings slope t + cubic t^3 and an alternating 1e-5, predicted as x0 t + x1 + x2 + x0 (x1 - x2) t^3: x1
/// and x2 are one constant but for the product.
Problem product(double slope, double cubic) {
  const VectorXd t = VectorXd::LinSpaced(40, -1, 1);
  VectorXd y(40);
  for (Eigen::Index i = 0; i < 40; ++i)
    y[i] = slope * t[i] + cubic * std::pow(t[i], 3) + (i % 2 == 0 ? 1e-5 : -1e-5);
  return {
      [=](const VectorXd& x) {
        return VectorXd{y.array() - x[0] * t.array() - x[1] - x[2] - x[0] * (x[1] - x[2]) * t.array().cube()};
      },
      [=](const VectorXd& x) {
        MatrixXd j(40, 3);
        j.col(0) = t.array() + (x[1] - x[2]) * t.array().cube();
        j.col(1) = 1 + x[0] * t.array().cube();
        j.col(2) = 1 - x[0] * t.array().cube();
        return j;
      }};
}

/// The second parameter acts by its product with the first, of which it takes 1e-4: the scale of its column
/// is that of its largest, at a start of 1.
TEST(Levenberg, DoesNotFollowAFaintDirectionForChance) {
  Problem problem = product(1e-4, 0);
  const LevenbergResult result = problem.solve(VectorXd::Zero(3), judged_by_chance());
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(std::count(result.held.begin(), result.held.end(), 1), 1);
  EXPECT_NEAR(result.point[1], result.point[2], 1e-6);
  EXPECT_NEAR(result.point[0], 1e-4, 1e-5);
}

/// A second parameter that shows only once the first has moved, and faintly: it may be followed, unless the
/// user of the fit says that its end is not to be believed.
TEST(Levenberg, GoesBackFromAnEndThatIsNotToBeBelieved) {
  Problem problem = product(2e-3, 2e-3);
  LevenbergOptions options = judged_by_chance();
  const LevenbergResult followed = problem.solve(VectorXd::Zero(3), options);
  options.believable = [](const VectorXd&, const VectorXd& to) { return std::abs(to[1] - to[2]) < 0.5; };
  const LevenbergResult kept = problem.solve(VectorXd::Zero(3), options);

  EXPECT_TRUE(followed.followed_unseen);
  EXPECT_GT(std::abs(followed.point[1] - followed.point[2]), 0.5);
  EXPECT_TRUE(kept.converged);
  EXPECT_FALSE(kept.followed_unseen);
  EXPECT_LT(std::abs(kept.point[1] - kept.point[2]), 0.1);
  EXPECT_EQ(std::count(kept.held.begin(), kept.held.end(), 1), 1);
  EXPECT_LT(followed.cost, kept.cost);
}

}  // namespace
}  // namespace vernier
