// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/envelope.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tests/unit/part/part_data.h"
#include "tools/part/surface/s_part.h"

namespace vernier::envelope_test {

using namespace vernier::part;
namespace {

constexpr NormalReading kPrinted{false, true}, kUnit{true, true}, kInward{false, false};

TEST(Envelope, EveryRowOfTheIndependentReference) {
  std::size_t seen = 0;
  const Cutter cutter;
  for (auto& row : part_data::rows("overcut_reference.csv")) {
    const RuledSurface& flank = s_part()[row["surface"] == "A" ? 0 : 1];
    // u is printed with six decimals; the grid has knots k/13 and fortieths of spans between them.
    const double u = std::round(part_data::number(row["u"]) * 520) / 520;
    if (u == 0 || u == 1) continue;  // there the reference steps aside by 1e-9
    const double v = part_data::number(row["z_mm"]) / kPartHeightMm;
    // Half a unit of the sixth decimal.
    EXPECT_NEAR(overcut_formula_mm(flank_pose(flank, cutter, u), cutter, v),
                part_data::number(row["formula_mm"]), 5.1e-7);
    EXPECT_NEAR(envelope_distance_mm(flank, cutter, u, v), part_data::number(row["signed_distance_mm"]),
                5.1e-7);
    ++seen;
  }
  EXPECT_GT(seen, 300u);
}

TEST(Envelope, LargestOvercutByBothReadingsAndAsDistance) {
  const Cutter cutter;
  const RuledSurface &a = s_part()[0], &b = s_part()[1];
  // To the digits of the reference's own sampling of the maximum (1e-5 mm; the largest value lies between
  // samples, so ours may be a little larger).
  EXPECT_NEAR(worst_formula(a, cutter, 0, kPrinted).value_mm, 0.041676, 1e-6);
  EXPECT_NEAR(worst_formula(a, cutter, 0, kPrinted).u, 11 / 13.0, 1e-6);
  EXPECT_NEAR(worst_formula(b, cutter, 0, kPrinted).value_mm, 0.025110, 1e-6);
  EXPECT_NEAR(worst_formula(a, cutter, 0, kUnit).value_mm, 0.035914, 2e-6);
  EXPECT_NEAR(worst_formula(b, cutter, 0, kUnit).value_mm, 0.026288, 2e-6);
  EXPECT_NEAR(worst_distance(a, cutter, 0).value_mm, 0.025704, 5e-5);
  EXPECT_NEAR(worst_distance(b, cutter, 0).value_mm, 0.021568, 5e-5);
  EXPECT_NEAR(worst_distance(a, cutter, 11 / 30.0).value_mm, 0.010682, 5e-5);
  EXPECT_LT(worst_distance(a, cutter, 25 / 30.0).value_mm, 0.001);
}

TEST(Envelope, PrintedOvercutOfFlankBNeedsTheNormalOnTheWrongSide) {
  // The paper prints 0.0125 (B) and 0.0387 (A). B is met to its last digit with the inward normal only; A by
  // no reading: the largest value is a cusp at a knot, 0.0417, which a coarse even grid misses.
  const Cutter cutter;
  EXPECT_NEAR(worst_formula(s_part()[1], cutter, 0, kInward).value_mm, 0.0125, 5e-5);
  for (const NormalReading reading : {kPrinted, kUnit, kInward})
    EXPECT_GT(std::abs(worst_formula(s_part()[0], cutter, 0, reading).value_mm - 0.0387), 0.0025);
  double coarse = 0;  // 77 even points
  for (int i = 0; i < 77; ++i)
    coarse =
        std::max(coarse, overcut_formula_mm(flank_pose(s_part()[0], cutter, i / 76.0, kPrinted), cutter, 0));
  EXPECT_NEAR(coarse, 0.0387, 5e-5);
}

TEST(Envelope, DistanceEqualsTheSweptCylinderByBruteForce) {
  // Second derivation without any normal or velocity: the surface point is as deep in the swept volume as the
  // nearest of all tool axes says. Both look at the surface from different sides of the gap, so they agree to
  // the gap times the angle between the normals (some percent of it).
  const Cutter cutter;
  for (const RuledSurface& flank : s_part())
    for (const double u : {0.15, 0.3038, 0.62, 0.8477, 0.93}) {
      const double wanted = envelope_distance_mm(flank, cutter, u, 0);
      const EnvelopePoint left = envelope_point(flank_pose(flank, cutter, u), cutter, 0);
      const SurfaceFoot foot = nearest(flank, left.position, u, 0);
      const Eigen::Vector3d point = surface_point(flank, foot.u, foot.v).position;
      double least = 1e9;
      for (int k = -4000; k <= 4000; ++k) {
        const FlankPose pose = flank_pose(flank, cutter, std::clamp(u + k * 1e-6 * 5, 0.0, 1.0));
        const Eigen::Vector3d offset = point - pose.tip;
        least = std::min(least, (offset - pose.axis * pose.axis.dot(offset)).norm());
      }
      EXPECT_NEAR(least - cutter.radius_mm, wanted, 1e-6 + 0.02 * std::abs(wanted)) << flank.name << " " << u;
    }
}

TEST(Envelope, PointIsTangentToAxisAndVelocity) {
  const Cutter cutter;
  constexpr double kStep = 1e-6;
  for (const double u : {0.1, 0.4, 0.77}) {
    const RuledSurface& flank = s_part()[0];
    const FlankPose here = flank_pose(flank, cutter, u);
    const EnvelopePoint point = envelope_point(here, cutter, 0.2);
    EXPECT_NEAR(point.normal.dot(here.axis), 0, 1e-12);
    const double h_mm = cutter.length_mm - 0.8 * here.generatrix_mm;
    const FlankPose before = flank_pose(flank, cutter, u - kStep),
                    after = flank_pose(flank, cutter, u + kStep);
    const Eigen::Vector3d speed =
        (after.tip + h_mm * after.axis - before.tip - h_mm * before.axis) / (2 * kStep);
    // Rounding of 150 mm over the step, against a speed of 600 mm.
    EXPECT_NEAR(point.normal.dot(speed.normalized()), 0, 1e-9);
  }
}

TEST(FlankPose, PrintedNormalIsNoUnitVector) {
  double least = 1;
  for (int i = 0; i <= 520; ++i)
    least = std::min(least, flank_pose(s_part()[0], {}, i / 520.0, kPrinted).normal.norm());
  EXPECT_NEAR(least, std::cos(16.1319 * M_PI / 180), 1e-5);  // 16.13 deg away from a right angle
  EXPECT_NEAR(flank_pose(s_part()[0], {}, 0.3, kUnit).normal.norm(), 1, 1e-14);
}

}  // namespace
}  // namespace vernier::envelope_test
