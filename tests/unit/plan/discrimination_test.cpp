// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "tools/maths/decompositions.h"
#include "tools/plan/choice.h"
#include "tools/plan/discrimination.h"

namespace vernier::discrimination_test {

using namespace vernier::plan;
namespace {

constexpr std::uint64_t kSeed = 20240611;

struct Problem {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd difference;
  std::vector<Eigen::Index> first;
};

/// `rows` rows of two observations, six parameters.
Problem random_problem(std::size_t rows, std::uint64_t seed) {
  std::cout << "seed " << seed << "\n";
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  Problem p;
  const auto count = static_cast<Eigen::Index>(2 * rows);
  p.jacobian = Eigen::MatrixXd::NullaryExpr(count, 6, [&] { return normal(engine); });
  p.difference = Eigen::VectorXd::NullaryExpr(count, [&] { return 3 * normal(engine); });
  for (std::size_t row = 0; row <= rows; ++row) p.first.push_back(static_cast<Eigen::Index>(2 * row));
  return p;
}

/// The same by its definition: what is left of the difference after a least-squares fit to the rows.
double left_over(const Problem& p, std::size_t existing, const std::vector<std::size_t>& chosen) {
  std::vector<Eigen::Index> which;
  for (std::size_t row = 0; row < existing; ++row)
    for (Eigen::Index i = p.first[row]; i < p.first[row + 1]; ++i) which.push_back(i);
  for (const std::size_t offer : chosen)
    for (Eigen::Index i = p.first[existing + offer]; i < p.first[existing + offer + 1]; ++i)
      which.push_back(i);
  const Eigen::MatrixXd j = p.jacobian(which, Eigen::all);
  const Eigen::VectorXd d = p.difference(which);
  return (d - j * maths::least_squares(j, d)).squaredNorm();
}

TEST(Discrimination, NonCentralityIsWhatARefitOfTheHypothesisLeaves) {
  const Problem p = random_problem(40, kSeed);
  Discrimination one(p.jacobian, p.difference, p.first, 20);
  // The ridge of 1e-10 of a column's length is all that parts the two.
  EXPECT_NEAR(one.non_centrality(), left_over(p, 20, {}), 1e-6);
  one.assume({3, 3, 17});
  EXPECT_NEAR(one.non_centrality(), left_over(p, 20, {3, 3, 17}), 1e-6);
}

TEST(Discrimination, GainIsWhatARowAddsWhenItIsAssumed) {
  const Problem p = random_problem(40, kSeed + 1);
  Discrimination one(p.jacobian, p.difference, p.first, 20);
  one.assume({5});
  const double before = one.non_centrality();
  const Eigen::VectorXd gains = one.gains();
  for (std::size_t offer = 0; offer < one.offers(); ++offer) {
    one.assume({5, offer});
    EXPECT_NEAR(before + gains[static_cast<Eigen::Index>(offer)], one.non_centrality(), 1e-6);
  }
}

TEST(Discrimination, ADirectionThatNoRowHasSeenCostsTheFirstRow) {
  // GIVEN a parameter that the existing rows do not see, and a difference that only new rows show
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(4, 1);
  jacobian(2, 0) = jacobian(3, 0) = 1;
  Eigen::VectorXd difference = Eigen::VectorXd::Zero(4);
  difference[2] = 5;
  difference[3] = -5;
  Discrimination one(jacobian, difference, {0, 1, 2, 3, 4}, 2);
  // THEN one new row is followed by that parameter; two of opposite difference are not
  EXPECT_NEAR(one.gains()[0], 0, 1e-6);
  one.assume({0, 1});
  EXPECT_NEAR(one.non_centrality(), 50, 1e-6);
}

TEST(NeededNonCentrality, NamesTheRightOneInThatShareOfTrials) {
  // The difference of chi^2 is lambda + 2 sqrt(lambda) z; at lambda it exceeds the lead in 95 of 100 cases.
  const double lead = 6, lambda = needed_non_centrality(0.95, lead);
  EXPECT_NEAR(lambda, 21.12, 0.01);
  std::mt19937_64 engine(kSeed);
  std::normal_distribution<double> normal;
  constexpr int kTrials = 200000;
  int right = 0;
  for (int i = 0; i < kTrials; ++i) right += lambda + 2 * std::sqrt(lambda) * normal(engine) > lead ? 1 : 0;
  // Four standard deviations of the binomial count.
  EXPECT_NEAR(right / static_cast<double>(kTrials), 0.95, 4 * std::sqrt(0.95 * 0.05 / kTrials));
}

TEST(ChooseRows, ReachesTheGoalWithNoMoreRowsThanRandomOnes) {
  // GIVEN offers of very unequal worth
  Problem p = random_problem(220, kSeed + 2);
  for (Eigen::Index i = 40; i < p.difference.size(); ++i) p.difference[i] *= (i / 2) % 10 == 0 ? 1.0 : 0.1;
  p.difference.head(40).setZero();
  Sides sides{{Discrimination(p.jacobian, p.difference, p.first, 20)}, {100}};
  std::vector<std::size_t> chosen;
  choose_rows(sides, chosen, 1, 60, 1);
  exchange_rows(sides, chosen);
  EXPECT_GE(sides.reached(), 1);
  EXPECT_NEAR(sides.side[0].non_centrality(), left_over(p, 20, chosen), 1e-6);
  // THEN as many rows in the order of the list stay below a half of it
  std::vector<std::size_t> plain(chosen.size());
  for (std::size_t i = 0; i < plain.size(); ++i) plain[i] = i + 1;
  EXPECT_LT(left_over(p, 20, plain), 50);
}

TEST(Discrimination, OneStepExplainsTwoLevelsAndNotAReturnToTheFirst) {
  // Ten rows at the first value of an input, ten at the second, and ten at the first again.
  constexpr Eigen::Index kRows = 10;
  constexpr double kSize = 3, kConfidence = 0.95, kLeadOfBic = 6, kPrice = 4;
  PredictedEffect there;
  there.readings = Eigen::VectorXd::Zero(2 * kRows);
  there.readings.tail(kRows).setConstant(kSize);
  there.constant = Eigen::VectorXd::Constant(2 * kRows, 1);
  there.free = Eigen::MatrixXd(2 * kRows, 0);
  there.places = {kRows};
  EXPECT_NEAR(beyond_one_step(there, kConfidence, kLeadOfBic, kPrice), 0, 1e-12);
  PredictedEffect back = there;
  back.readings.conservativeResize(3 * kRows);
  back.readings.tail(kRows).setZero();
  back.constant = Eigen::VectorXd::Constant(3 * kRows, 1);
  back.free = Eigen::MatrixXd(3 * kRows, 0);
  back.places = {kRows, 2 * kRows};
  // Half of the size is left in the rows of both levels that the step does not separate.
  const double left = 2 * kRows * kSize * kSize / 4;
  EXPECT_NEAR(beyond_one_step(back, kConfidence, kLeadOfBic, kPrice),
              left / needed_non_centrality(kConfidence, kLeadOfBic), 1e-9);
  // A free shift of the last rows takes the return away.
  back.free = Eigen::MatrixXd::Zero(3 * kRows, 1);
  back.free.bottomRows(kRows).setOnes();
  EXPECT_NEAR(beyond_one_step(back, kConfidence, kLeadOfBic, kPrice), 0, 1e-12);
}

}  // namespace
}  // namespace vernier::discrimination_test
