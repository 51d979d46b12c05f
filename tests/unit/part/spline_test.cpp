// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/surface/spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace vernier::spline_test {

using namespace vernier::part;
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Second derivation: the sum of control points times basis functions by the recursion of Cox and de Boor.
double basis(const std::vector<double>& knots, std::size_t i, std::size_t degree, double u) {
  if (degree == 0) {
    const bool last = knots[i + 1] == 1 && knots[i] < 1 && u == 1;
    return (knots[i] <= u && u < knots[i + 1]) || last ? 1 : 0;
  }
  double sum = 0;
  if (knots[i + degree] > knots[i])
    sum += (u - knots[i]) / (knots[i + degree] - knots[i]) * basis(knots, i, degree - 1, u);
  if (knots[i + degree + 1] > knots[i + 1])
    sum += (knots[i + degree + 1] - u) / (knots[i + degree + 1] - knots[i + 1]) *
           basis(knots, i + 1, degree - 1, u);
  return sum;
}

Points random_points(std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> mm(-150, 150);
  Points points;
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(mm(generator), mm(generator), mm(generator));
  return points;
}

std::vector<double> knots_for(std::size_t points) {
  const std::size_t spans = points - 3;
  std::vector<double> knots(4, 0.0);
  for (std::size_t i = 1; i < spans; ++i)
    knots.push_back(static_cast<double>(i) / static_cast<double>(spans));
  knots.insert(knots.end(), 4, 1.0);
  return knots;
}

TEST(Spline, EqualsTheSumOfBasisFunctions) {
  for (const std::size_t count : {4u, 5u, 7u, 16u}) {
    const unsigned seed = 11 + static_cast<unsigned>(count);
    SCOPED_TRACE("points " + std::to_string(count) + ", seed " + std::to_string(seed));
    const Points points = random_points(count, seed);
    const Spline spline(points);
    const std::vector<double> knots = knots_for(count);
    for (int k = 0; k <= 130; ++k) {
      const double u = k / 130.0;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < count; ++i) sum += basis(knots, i, 3, u) * points[i];
      // Rounding of sums of four terms of 150 mm.
      EXPECT_LT((spline.at(u).position - sum).norm(), 1e-12) << "u " << u;
    }
  }
}

TEST(Spline, DerivativesEqualCentralDifferences) {
  const Spline spline(random_points(16, 5));
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 100; ++k) {
    const double u = (k + 0.5) / 100;  // never within a step of a knot
    const CurvePoint before = spline.at(u - kStep), here = spline.at(u), after = spline.at(u + kStep);
    // Third derivative at most 6 * 13^3 * 8 * 150 mm = 1.6e7 mm, times step^2 / 6.
    EXPECT_LT((here.first - (after.position - before.position) / (2 * kStep)).norm(), 3e-4);
    // The second is linear in a span: rounding of the first (1e4 mm) over the step alone.
    EXPECT_LT((here.second - (after.first - before.first) / (2 * kStep)).norm(), 1e-5);
  }
}

TEST(Spline, BeginsAndEndsAtItsControlPolygon) {
  const Points points = random_points(16, 6);
  const Spline spline(points);
  EXPECT_LT((spline.at(0).position - points.front()).norm(), 1e-13);
  EXPECT_LT((spline.at(1).position - points.back()).norm(), 1e-13);
  // Clamped: the first knot span is 1/13, so the end slope is 3 * 13 times the first leg.
  EXPECT_LT((spline.at(0).first - 39 * (points[1] - points[0])).norm(), 1e-9);
  EXPECT_LT((spline.at(1).first - 39 * (points[15] - points[14])).norm(), 1e-9);
}

TEST(Spline, IsTwiceSmoothAtEveryKnot) {
  const Spline spline(random_points(16, 7));
  for (int k = 1; k < 13; ++k) {
    const double knot = k / 13.0, least = std::nextafter(knot, 0.0);
    const CurvePoint left = spline.at(least), right = spline.at(knot);
    EXPECT_LT((left.position - right.position).norm(), 1e-11);
    EXPECT_LT((left.first - right.first).norm(), 1e-9);
    EXPECT_LT((left.second - right.second).norm(), 1e-7);
  }
}

TEST(Spline, StraightEvenPolygonHasItsLength) {
  // Greville abscissae on a line make the curve u itself: length to rounding.
  Points points;
  const std::vector<double> knots = knots_for(9);
  for (std::size_t i = 0; i < 9; ++i)
    points.emplace_back(90 * (knots[i + 1] + knots[i + 2] + knots[i + 3]) / 3, 0, 0);
  const Spline spline(points);
  EXPECT_NEAR(spline.length_mm(), 90, 1e-12);
  EXPECT_NEAR(spline.at(0.3).position.x(), 27, 1e-12);
}

TEST(Spline, ThreePointsAreTooFew) { EXPECT_THROW(Spline(random_points(3, 1)), std::invalid_argument); }

}  // namespace
}  // namespace vernier::spline_test
