// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/feature.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include "tools/text/error.h"

namespace vernier::feature_test {

using namespace vernier::probe;
using namespace vernier::format;
using namespace vernier::text;
namespace {

using Eigen::Vector3d;

/// Touches of a ball on points of a surface with outward normals, with noise along them.
class Touched {
 public:
  Touched(double ball, double noise, std::uint64_t seed) : ball_(ball), noise_(0, noise), random_(seed) {
    text_.precision(14);
    text_ << "x[mm],y[mm],z[mm],nx,ny,nz\n";
  }
  void at(const Vector3d& surface, const Vector3d& n) {
    const Vector3d p = surface + (ball_ + noise_(random_)) * n;
    text_ << p(0) << ',' << p(1) << ',' << p(2) << ',' << n(0) << ',' << n(1) << ',' << n(2) << '\n';
  }
  MeasuredFeature fit(FeatureSetup setup) const {
    setup.ball_radius_mm = ball_;
    TouchTable table(text_.str(), "touches.csv", {}, {});
    return fit_feature(table, setup);
  }
  std::string text() const { return text_.str(); }

 private:
  double ball_;
  std::normal_distribution<double> noise_;
  std::mt19937_64 random_;
  std::ostringstream text_;
};

void expect_near(const MeasuredFeature& feature, const std::string& name, double truth) {
  const Calibrated* const found = feature.find(name);
  ASSERT_NE(found, nullptr) << name;
  EXPECT_NEAR(found->value, truth, 4.5 * found->std + 1e-9) << name;
}

const Eigen::Matrix3d kTurn =
    (Eigen::AngleAxisd(0.3, Vector3d::UnitX()) * Eigen::AngleAxisd(-0.5, Vector3d::UnitY()))
        .toRotationMatrix();
const Vector3d kAt(120, -40, 15);

TEST(MeasuredFeature, PlaneLineSphereAndCylinderAnywhereInSpace) {
  Touched plane(2.5, 1e-3, 1), sphere(2.5, 1e-3, 2), cylinder(2.5, 1e-3, 3), bore(2.5, 1e-3, 4);
  for (int i = 0; i < 60; ++i) {
    const double a = 0.61 * i, b = std::sin(1.7 * i);
    plane.at(kAt + kTurn * Vector3d(30 * std::cos(a), 20 * b, 0), kTurn.col(2));
    const Vector3d n = Vector3d(std::cos(a), std::sin(a), 0.9 * b).normalized();
    sphere.at(kAt + 12.7 * n, n);
    const Vector3d radial = kTurn * Vector3d(std::cos(a), std::sin(a), 0);
    cylinder.at(kAt + 9 * radial + 25 * b * kTurn.col(2), radial);
    bore.at(kAt + 9 * radial + 25 * b * kTurn.col(2), -radial);
  }
  const MeasuredFeature p = plane.fit({.kind = FeatureKind::kPlane});
  expect_near(p, "normal_x", kTurn(0, 2));
  expect_near(p, "normal_y", kTurn(1, 2));
  const Vector3d on(p.find("point_x")->value, p.find("point_y")->value, p.find("point_z")->value);
  EXPECT_NEAR((on - kAt).dot(kTurn.col(2)), 0, 1e-3);
  const MeasuredFeature s = sphere.fit({.kind = FeatureKind::kSphere});
  expect_near(s, "centre_x", 120);
  expect_near(s, "radius", 12.7);
  for (const Touched* round : {&cylinder, &bore}) {
    const MeasuredFeature c = round->fit({.kind = FeatureKind::kCylinder});
    expect_near(c, "radius", 9);
    expect_near(c, "axis_x", kTurn(0, 2));
    EXPECT_NEAR(c.form_mm, 4.5e-3, 2e-3);
    EXPECT_TRUE(c.fit.outliers.empty());
  }
}

TEST(MeasuredFeature, CircleAndLineInThePlane) {
  std::ostringstream circle, line;
  circle << "x,y\n", line << "x,y\n";
  for (int i = 0; i < 12; ++i) {
    const double a = 2 * std::numbers::pi * i / 12;
    circle << 5 + 17.5 * std::cos(a) << ',' << -3 + 17.5 * std::sin(a) << '\n';
    line << i << ',' << 2 + 0.1 * i << '\n';
  }
  TouchTable round(circle.str(), "c.csv", {}, {}), straight(line.str(), "l.csv", {}, {});
  const MeasuredFeature c =
      fit_feature(round, {.kind = FeatureKind::kCircle, .ball_radius_mm = 2.5, .inside = true});
  EXPECT_NEAR(c.find("radius")->value, 20, 1e-4);
  EXPECT_NEAR(c.find("centre_x")->value, 5, 1e-4);
  const MeasuredFeature l = fit_feature(straight, {.kind = FeatureKind::kLine});
  EXPECT_NEAR(l.find("angle")->value, std::atan(0.1) * 180 / std::numbers::pi, 1e-6);
}

std::string block_touches(double angle, const Vector3d& centre, double x, double y, double ball) {
  std::ostringstream text;
  text.precision(14);
  text << "x[mm],y[mm],nx,ny\n";
  const Vector3d ex(std::cos(angle), std::sin(angle), 0), ey(-std::sin(angle), std::cos(angle), 0);
  for (const double off : {-5.0, 5.0}) {
    const Vector3d px = centre + (x / 2 + ball) * ex + off * ey, py = centre - (y / 2 + ball) * ey + off * ex;
    text << px(0) << ',' << px(1) << ",1,0\n" << py(0) << ',' << py(1) << ",0,-1\n";
  }
  return text.str();
}

TEST(MeasuredFeature, BlockFromTwoPlusTwoPointsIsWhereItIs) {
  for (const double deg : {-10.0, 0.0, 3.0, 20.0}) {
    const double angle = deg * std::numbers::pi / 180;
    TouchTable table(block_touches(angle, {114.98, 4.1, 0}, 35, 20, 1.987 / 2), "b.csv", {}, {});
    const MeasuredFeature block = fit_feature(
        table, {.kind = FeatureKind::kBlock, .ball_radius_mm = 1.987 / 2, .block_size_mm = {35, 20}});
    EXPECT_NEAR(block.find("centre_x")->value, 114.98, 1e-6);
    EXPECT_NEAR(block.find("centre_y")->value, 4.1, 1e-6);
    EXPECT_NEAR(block.find("angle")->value, deg, 1e-6);
  }
}

TEST(MeasuredFeature, SizeIsThatAtTwentyDegrees) {
  Touched sphere(2.5, 0.1e-3, 7);
  constexpr double kExpansion = 11.5e-6, kT = 26;
  std::ostringstream text;
  text.precision(14);
  text << "x[mm],y[mm],z[mm],T[degC]\n";
  for (int i = 0; i < 40; ++i) {
    const Vector3d n = Vector3d(std::cos(0.7 * i), std::sin(0.7 * i), std::sin(1.3 * i)).normalized();
    const Vector3d p = (1 + kExpansion * (kT - 20)) * (Vector3d(100, 0, 0) + 25 * n);
    text << p(0) << ',' << p(1) << ',' << p(2) << ',' << kT << '\n';
  }
  TouchTable table(text.str(), "s.csv", {}, {});
  const MeasuredFeature s = fit_feature(table, {.kind = FeatureKind::kSphere, .expansion_per_K = kExpansion});
  EXPECT_NEAR(s.find("radius")->value, 25, 1e-6);
  EXPECT_NEAR(s.find("centre_x")->value, 100, 1e-6);
  EXPECT_NEAR(s.find("radius")->std, 25 * std::hypot(1e-6 * 6, 11.5e-6 * 0.1), 1e-6);
}

TEST(MeasuredFeature, RowsForAFitAreDeviationsFromTheFeature) {
  Touched plane(2.5, 2e-3, 9);
  for (int i = 0; i < 20; ++i) plane.at(Vector3d(3.0 * i, std::cos(1.0 * i), 4), Vector3d::UnitZ());
  TouchTable table(plane.text(), "touches.csv", {}, {});
  const FeatureSetup setup{.kind = FeatureKind::kPlane, .ball_radius_mm = 2.5};
  const MeasuredFeature feature = fit_feature(table, setup);
  const CsvFile rows = parse_csv(feature_csv(table, feature), "rows.csv");
  ASSERT_EQ(rows.rows.size(), 20u);
  ASSERT_EQ(rows.columns.size(), 7u);
  EXPECT_EQ(rows.columns[0].name, "d");
  for (std::size_t i = 0; i < 20; ++i) {
    // The recorded point is the nominal one plus d along the normal.
    const double pz = std::stod(rows.rows[i][6]), d = std::stod(rows.rows[i][0]),
                 nz = std::stod(rows.rows[i][3]);
    EXPECT_NEAR(pz + d * nz, feature.points(static_cast<Eigen::Index>(i), 2), 1e-8);
  }
}

TEST(MeasuredFeature, LeavesOutATouchThatIsNone) {
  Touched sphere(2.5, 1e-3, 11);
  for (int i = 0; i < 30; ++i) {
    const Vector3d n = Vector3d(std::cos(0.7 * i), std::sin(0.7 * i), std::sin(1.3 * i)).normalized();
    sphere.at((i == 13 ? 10.05 : 10) * n, n);
  }
  const MeasuredFeature s = sphere.fit({.kind = FeatureKind::kSphere});
  ASSERT_EQ(s.fit.outliers.size(), 1u);
  EXPECT_EQ(s.fit.outliers[0].touch, 13u);
  expect_near(s, "radius", 10);
}

}  // namespace
}  // namespace vernier::feature_test
