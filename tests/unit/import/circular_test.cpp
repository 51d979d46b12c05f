// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/import/ballbar_data.h"
#include "tools/import/ballbar/b5r_reader.h"
#include "tools/import/ballbar/ballbar_motion.h"

namespace vernier::circular_test {

using namespace vernier::importer;
namespace {

const BallbarFile& the_file() {
  static const BallbarFile kFile = read_b5r(ballbar_data("ur10e_xy_100mm.b5r"));
  return kFile;
}

CircularResult the_circle() { return analyse_circle(the_file().radius_mm, circular_passes(the_file())); }

// Half of the last printed digit.
constexpr double kHalfUm = 0.05, kHalfMm = 0.5e-4, kHalfFeed = 0.05, kHalfDeg = 0.5e-5;

TEST(Circular, NumbersOfTheFileToTheLastDigit) {
  const CircularResult circle = the_circle();
  const CircularPassResult &ccw = circle.passes.at(0), &cw = circle.passes.at(1);
  EXPECT_NEAR(ccw.centre_a_mm, -0.0780, kHalfMm);
  EXPECT_NEAR(ccw.centre_b_mm, 0.0016, kHalfMm);
  EXPECT_NEAR(ccw.radius_mm, 99.9954, kHalfMm);
  EXPECT_NEAR(ccw.circular_deviation_um / 1000, 0.3933, kHalfMm);
  EXPECT_NEAR(*ccw.feed_mm_min, 4742.0, kHalfFeed);
  EXPECT_NEAR(cw.centre_a_mm, -0.0510, kHalfMm);
  EXPECT_NEAR(cw.centre_b_mm, -0.0394, kHalfMm);
  EXPECT_NEAR(cw.radius_mm, 100.0051, kHalfMm);
  EXPECT_NEAR(*cw.feed_mm_min, 5228.7, kHalfFeed);
  EXPECT_NEAR(*circle.bidirectional_um, 437.4, kHalfUm);
  EXPECT_NEAR(circle.hysteresis->um, 313.7, kHalfUm);
  EXPECT_NEAR(circle.hysteresis->deg, 199.34813, kHalfDeg);
  EXPECT_NEAR(cw.max_radial_um, 202.2, kHalfUm);
  EXPECT_NEAR(cw.max_deg, 8.61304, kHalfDeg);
  EXPECT_NEAR(ccw.min_radial_um, -187.8, kHalfUm);
  EXPECT_NEAR(ccw.min_deg, 173.32075, kHalfDeg);
}

TEST(Circular, HysteresisByTrueAngleIsAnotherNumber) {
  // 319.0 um at 9.36 deg: an independent computation, printed with one and two digits.
  const CircularResult circle = the_circle();
  EXPECT_NEAR(circle.hysteresis_by_angle->um, 319.0, kHalfUm);
  EXPECT_NEAR(circle.hysteresis_by_angle->deg, 9.36, 0.005);
}

TEST(Circular, KnownEccentricEllipseComesBack) {
  // GIVEN both senses of a circle with a known centre, radius, ellipse and a radius that differs between the
  // senses
  std::vector<CircularPass> passes;
  for (const int direction : {+1, -1}) {
    CircularPass pass{direction > 0 ? "up" : "down", direction, {}, {}, std::nullopt};
    for (int k = 0; k < 720; ++k) {
      const double degrees = direction > 0 ? (k + 0.5) / 2 : 360 - (k + 0.5) / 2,
                   t = degrees * std::numbers::pi / 180;
      pass.angle_deg.push_back(degrees);
      pass.deviation_mm.push_back(0.02 * std::cos(t) - 0.03 * std::sin(t) + 0.004 + 0.010 * std::cos(2 * t) +
                                  direction * 0.0015);
    }
    passes.push_back(pass);
  }
  const CircularResult circle = analyse_circle(150, passes);
  // THEN the numbers are those of the formula; 1e-3 um: the peak of cos(2T) lies a quarter of a degree from a
  // sample
  for (const auto& pass : circle.passes) {
    EXPECT_NEAR(pass.centre_a_mm, 0.02, 1e-12);
    EXPECT_NEAR(pass.centre_b_mm, -0.03, 1e-12);
    EXPECT_NEAR(pass.radius_mm, 150.004 + pass.direction * 0.0015, 1e-9);
    EXPECT_NEAR(pass.circular_deviation_um, 20, 1e-3);
    EXPECT_NEAR(pass.max_radial_um, 14 + pass.direction * 1.5, 1e-3);
  }
  EXPECT_NEAR(*circle.bidirectional_um, 20, 1e-3);
  EXPECT_NEAR(circle.hysteresis->um, 3, 1e-9);
  EXPECT_NEAR(circle.hysteresis_by_angle->um, 3, 1e-9);
  EXPECT_NEAR(circle.about_mean->max_um - circle.about_mean->min_um, 23, 1e-3);
}

TEST(Circular, RadiusOfTheTrueDistancesIsExactWhereTheLinearisedOneIsNot) {
  // GIVEN a true circle of 150.010 mm whose centre lies 0.5 mm off, in both senses
  std::vector<CircularPass> passes;
  for (const int direction : {+1, -1}) {
    CircularPass pass{direction > 0 ? "up" : "down", direction, {}, {}, std::nullopt};
    for (int k = 0; k < 720; ++k) {
      const double t = (k + 0.5) * std::numbers::pi / 360, radius = 150.010;
      // Distance from the origin of the point of the circle in that direction: the positive root.
      const double along = 0.3 * std::cos(t) + 0.4 * std::sin(t),
                   across = 0.3 * std::sin(t) - 0.4 * std::cos(t);
      pass.angle_deg.push_back((k + 0.5) / 2);
      pass.deviation_mm.push_back(along + std::sqrt(radius * radius - across * across) - 150);
    }
    passes.push_back(pass);
  }
  const CircularResult circle = analyse_circle(150, passes);
  EXPECT_NEAR(*circle.mean_bidirectional_radial_um, 10, 1e-6);
  // THEN the linearised one is short by e^2 / 4R = 0.4166 um; what is left out is e^4 / R^3.
  EXPECT_NEAR((*circle.mean_radius_mm - 150) * 1000, 10 - 0.25 / 600.04 * 1000, 1e-4);
}

TEST(Circular, OneSenseAloneHasNoBidirectionalNumbers) {
  const CircularResult circle = analyse_circle(100, {circular_passes(the_file())[0]});
  EXPECT_EQ(circle.passes.size(), 1u);
  EXPECT_FALSE(circle.bidirectional_um || circle.hysteresis || circle.hysteresis_by_angle ||
               circle.about_mean || circle.mean_bidirectional_radial_um);
}

TEST(Circular, TooFewOrCoincidentSamplesAreRefused) {
  EXPECT_THROW(analyse_circle(100, {{"a", 1, {10, 20}, {0, 0}, {}}}), std::invalid_argument);
  EXPECT_THROW(analyse_circle(100, {{"a", 1, {10, 10, 10, 10}, {0, 0, 0, 0}, {}}}), std::invalid_argument);
  EXPECT_THROW(analyse_circle(100, {{"a", 1, {10, 20, 30}, {0, 0}, {}}}), std::invalid_argument);
}

TEST(Circular, OpenArcIsNotClosedAcrossItsGap) {
  // GIVEN a half circle in one sense and a full one in the other, equal but for 50 um in the half that only
  // one has seen
  CircularPass half{"half", +1, {}, {}, {}}, full{"full", -1, {}, {}, {}};
  for (int k = 0; k < 180; ++k) {
    half.angle_deg.push_back(k + 0.5);
    half.deviation_mm.push_back(0);
  }
  for (int k = 0; k < 360; ++k) {
    full.angle_deg.push_back(360 - (k + 0.5));
    full.deviation_mm.push_back(0);
  }
  for (int k = 60; k < 120; ++k) full.deviation_mm[static_cast<std::size_t>(k)] = 0.05;
  const CircularResult circle = analyse_circle(100, {half, full});
  // THEN the hysteresis is found where both have samples
  EXPECT_LT(circle.hysteresis_by_angle->deg, 180);
}

}  // namespace
}  // namespace vernier::circular_test
