// SPDX-License-Identifier: GPL-3.0-or-later
// Which columns explain a residual: against hand-made traps and against trying everything.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tools/diagnose/propose/selection.h"
#include "tools/maths/decompositions.h"

namespace vernier::selection_test {

using namespace vernier::diagnose;
namespace {

constexpr std::uint64_t kSeed = 31;

/// Columns of length 1, one entry each, against a residual.
SelectionProblem problem_of(Eigen::MatrixXd columns, const Eigen::VectorXd& residual, bool noise_known) {
  SelectionProblem p;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    columns.col(j).normalize();
    SelectionEntry entry;
    entry.first = j;
    entry.penalty = 2 * std::log(static_cast<double>(columns.cols()));
    entry.cause = static_cast<std::size_t>(j);
    p.entries.push_back(entry);
  }
  p.gram = columns.transpose() * columns;
  p.moment = columns.transpose() * residual;
  p.chi_square = residual.squaredNorm();
  p.observations = static_cast<double>(residual.size());
  p.freedom = p.observations;
  p.noise_known = noise_known;
  return p;
}

Eigen::MatrixXd random_columns(Eigen::Index rows, Eigen::Index count, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, count, [&] { return normal(random); });
}

std::vector<std::size_t> sorted(std::vector<std::size_t> list) {
  std::sort(list.begin(), list.end());
  return list;
}

/// The best of all sets of at most three entries.
double least_of_all(const SelectionProblem& p) {
  double least = evaluate_selection(p, {}).criterion;
  const std::size_t n = p.entries.size();
  for (std::size_t a = 0; a < n; ++a) {
    least = std::min(least, evaluate_selection(p, {a}).criterion);
    for (std::size_t b = 0; b < a; ++b) {
      least = std::min(least, evaluate_selection(p, {a, b}).criterion);
      for (std::size_t c = 0; c < b; ++c) least = std::min(least, evaluate_selection(p, {a, b, c}).criterion);
    }
  }
  return least;
}

TEST(Selection, CriterionIsBicWithTheLeastSquaresOfTheColumns) {
  std::mt19937_64 random(kSeed);
  const Eigen::MatrixXd columns = random_columns(50, 3, random);
  const Eigen::VectorXd residual = random_columns(50, 1, random);
  const SelectionProblem p = problem_of(columns, residual, false);
  Eigen::MatrixXd two(50, 2);
  two << columns.col(0), columns.col(2);
  const Eigen::VectorXd k = maths::least_squares(two, residual);
  const double chi_square = (residual - two * k).squaredNorm();
  const Selection both = evaluate_selection(p, {0, 2});
  EXPECT_NEAR(both.chi_square, chi_square, 1e-9 * chi_square);
  EXPECT_NEAR(both.criterion, 50 * (1 + std::log(chi_square / 50)) + 2 * std::log(50.0) + 4 * std::log(3.0),
              1e-9);
  const Eigen::VectorXd own = coefficients(p, {0, 2});
  EXPECT_NEAR(own[0] / columns.col(0).norm(), k[0], 1e-9);
  EXPECT_NEAR(own[1] / columns.col(2).norm(), k[1], 1e-9);
}

/// A residual below the given uncertainty is no reason to believe in a smaller one.
TEST(Selection, GivenNoiseIsAFloor) {
  std::mt19937_64 random(kSeed);
  const Eigen::MatrixXd columns = random_columns(200, 10, random);
  const Eigen::VectorXd residual = 0.2 * random_columns(200, 1, random) + 0.02 * columns.col(3);
  EXPECT_TRUE(select(problem_of(columns, residual, true), 3).chosen.empty());
  const SelectionProblem unknown = problem_of(columns, 5 * residual + 0.5 * columns.col(3), false);
  EXPECT_EQ(select(unknown, 3).chosen, std::vector<std::size_t>{3});
  const SelectionProblem known = problem_of(columns, 5 * residual + 0.5 * columns.col(3), true);
  EXPECT_EQ(select(known, 3).chosen, std::vector<std::size_t>{3});
}

TEST(Selection, NamesNothingInNoise) {
  std::mt19937_64 random(kSeed);
  std::size_t named = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::MatrixXd columns = random_columns(100, 40, random);
    named += select(problem_of(columns, random_columns(100, 1, random), true), 4).chosen.empty() ? 0 : 1;
  }
  // A column wins by chance with 40 * P(chi^2_1 > ln 100 + 2 ln 40 = 12) = 2 %.
  EXPECT_LE(named, 12U);
}

/// The sum of two causes looks most like a third: forward steps take it and stay with it.
TEST(Selection, ExchangeCuresAConfounder) {
  std::mt19937_64 random(kSeed);
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::MatrixXd columns = random_columns(300, 12, random);
    columns.col(7) = columns.col(2) + columns.col(5) + 0.3 * columns.col(7);
    const Eigen::VectorXd residual = 2 * columns.col(2) + 2 * columns.col(5) + random_columns(300, 1, random);
    const SelectionProblem p = problem_of(columns, residual, trial % 2 == 0);
    std::size_t first = 0;
    for (std::size_t i = 1; i < 12; ++i)
      if (evaluate_selection(p, {i}).criterion < evaluate_selection(p, {first}).criterion) first = i;
    EXPECT_EQ(first, 7U) << "the trap is one";
    const std::vector<std::size_t> chosen = sorted(select(p, 2).chosen);
    EXPECT_EQ(chosen, (std::vector<std::size_t>{2, 5}));
  }
}

/// Two nearly equal columns, and the residual is their difference: neither helps alone.
TEST(Selection, FindsAPairThatHidesEachOther) {
  std::mt19937_64 random(kSeed);
  Eigen::MatrixXd columns = random_columns(400, 8, random);
  columns.col(6) = columns.col(1) + 0.1 * columns.col(6);
  const Eigen::VectorXd residual = 20 * (columns.col(6) - columns.col(1)) + random_columns(400, 1, random);
  const SelectionProblem p = problem_of(columns, residual, true);
  EXPECT_EQ(sorted(select(p, 3).chosen), (std::vector<std::size_t>{1, 6}));
}

TEST(Selection, RefusesColumnsThatDependOnEachOther) {
  std::mt19937_64 random(kSeed);
  Eigen::MatrixXd columns = random_columns(60, 4, random);
  columns.col(3) = columns.col(0) - 2 * columns.col(1);
  const Eigen::VectorXd residual = 3 * columns.col(3) + random_columns(60, 1, random);
  const SelectionProblem p = problem_of(columns, residual, true);
  EXPECT_EQ(evaluate_selection(p, {0, 1, 3}).criterion, std::numeric_limits<double>::infinity());
  EXPECT_EQ(evaluate_selection(p, {2, 2}).criterion, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isfinite(evaluate_selection(p, {0, 1}).criterion));
  EXPECT_EQ(select(p, 4).chosen, std::vector<std::size_t>{3});
}

TEST(Selection, TakesOneEntryOfACause) {
  std::mt19937_64 random(kSeed);
  const Eigen::MatrixXd columns = random_columns(100, 4, random);
  const Eigen::VectorXd residual = 3 * columns.col(0) + 2 * columns.col(1) + random_columns(100, 1, random);
  SelectionProblem p = problem_of(columns, residual, true);
  EXPECT_EQ(sorted(select(p, 4).chosen), (std::vector<std::size_t>{0, 1}));
  p.entries[1].cause = p.entries[0].cause;
  EXPECT_EQ(select(p, 4).chosen, std::vector<std::size_t>{0});
}

TEST(Selection, OrdersByWhatEachStepWins) {
  std::mt19937_64 random(kSeed);
  const Eigen::MatrixXd columns = random_columns(300, 6, random);
  const Eigen::VectorXd residual = columns.col(0) + 5 * columns.col(4) + 2 * columns.col(2);
  const SelectionProblem p = problem_of(columns, residual + random_columns(300, 1, random), true);
  EXPECT_EQ(select(p, 5).chosen, (std::vector<std::size_t>{4, 2, 0}));
  EXPECT_EQ(select(p, 2).chosen, (std::vector<std::size_t>{4, 2}));
}

/// Readings that hang together count for less: the same columns are no evidence any more.
/// Small problems with correlated columns: nothing of up to three entries is better than what is found.
TEST(Selection, IsAsGoodAsTryingEverything) {
  RecordProperty("seed", static_cast<int>(kSeed));
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t missed = 0;
  constexpr std::size_t kTrials = 150;
  for (std::size_t trial = 0; trial < kTrials; ++trial) {
    Eigen::MatrixXd columns = random_columns(60, 9, random);
    for (Eigen::Index j = 1; j < 9; ++j) columns.col(j) += 1.5 * unit(random) * columns.col(j - 1);
    Eigen::VectorXd residual = random_columns(60, 1, random);
    for (int term = 0; term < 3; ++term)
      residual += 2 * (unit(random) - 0.5) * columns.col(static_cast<Eigen::Index>(unit(random) * 9));
    const SelectionProblem p = problem_of(columns, residual, trial % 2 == 0);
    missed += select(p, 3).criterion > least_of_all(p) + 1e-6 ? 1 : 0;
  }
  // Steps, pairs and exchanges are no proof of the least; one in fifty may be missed.
  EXPECT_LE(missed, kTrials / 50);
}

}  // namespace
}  // namespace vernier::selection_test
