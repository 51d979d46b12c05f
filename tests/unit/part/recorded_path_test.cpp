// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/recorded_path.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/part/part_data.h"
#include "tools/part/envelope.h"
#include "tools/part/part_path.h"
#include "tools/part/surface/s_part.h"
#include "tools/part/surface/spline_program.h"

namespace vernier::recorded_test {

using namespace vernier::part;
using namespace vernier::text;
namespace {

/// The paths of both flanks one after the other, every 0.1 mm: straight steps of the axes leave less than
/// 0.15 um of the tool's path.
RecordedPath programmed(const BHeadMachine& machine, const Cutter& cutter) {
  RecordedPath recorded{"record.csv", {}};
  PathOptions options;
  options.cutter = cutter;
  options.step_mm = 0.1;
  for (std::size_t flank = 0; flank < s_part().size(); ++flank)
    for (const JointPose& q : part_path(machine, flank, options).joints) recorded.joints.push_back(q);
  return recorded;
}

TEST(RecordedPath, ThePathItselfLeavesWhatACylinderCannotCut) {
  const BHeadMachine machine = part_data::machine();
  for (const ToolPath path : {ToolPath::kAnalytical, ToolPath::kTp5c1, ToolPath::kTp6c2}) {
    const double touch = touch_of(path);
    const Cutter cutter{10, 35, touch};
    const auto points = standard_points();
    const RecordedDeviations found =
        recorded_deviations(machine, programmed(machine, cutter), points, cutter);
    ASSERT_EQ(found.points.size(), 100u);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_NEAR(found.points[i].controller_mm(), 0, 2e-4) << i << " touch " << touch;
      // A second way to the same number: the foot of the envelope's point. It is of the same u, not of the
      // same point: 0.55 mm beside it at most, on slopes below 2 um in that.
      const double envelope =
          envelope_distance_mm(s_part()[points[i].flank], cutter, points[i].u, points[i].v);
      EXPECT_NEAR(found.points[i].path_mm, envelope, 2e-3) << i << " touch " << touch;
    }
  }
  // On the curve that is touched nothing is cut too much.
  const Cutter foot{10, 35, 0};
  for (const double u : {0.02, 0.3, 0.5, 0.77}) {
    EXPECT_NEAR(envelope_distance_mm(s_part()[0], foot, u, 0), 0, 1e-9);
    EXPECT_NEAR(envelope_distance_mm(s_part()[1], {10, 35, touch_of(ToolPath::kTp6c2)}, u, 11.0 / 30), 0,
                1e-9);
  }
  EXPECT_LT(envelope_distance_mm(s_part()[0], foot, 11.0 / 13, 1), -0.005);
}

TEST(RecordedPath, TipsMoveAsTheirDerivativesSayWhereverTheCutterTouches) {
  constexpr double kStep = 1e-6;
  for (const double touch : {0.0, 11.0 / 30, 1.0}) {
    const Cutter cutter{10, 35, touch};
    const auto tip = [&](double u) { return flank_pose(s_part()[0], cutter, u).tip; };
    const Eigen::Vector3d slope = (tip(0.31 + kStep) - tip(0.31 - kStep)) / (2 * kStep);
    const FlankPose pose = flank_pose(s_part()[0], cutter, 0.31);
    EXPECT_LT((slope - pose.tip_du).norm(), 1e-4 * pose.tip_du.norm()) << touch;
    // The axis stands a radius off the point that is touched, along the surface's own normal there.
    const SurfacePoint at = surface_point(s_part()[0], 0.31, touch);
    EXPECT_NEAR((pose.normal - at.normal).norm(), 0, 1e-12) << touch;
  }
}

TEST(RecordedPath, AnAxisThatWasOffShowsAlongTheNormal) {
  const BHeadMachine machine = part_data::machine();
  const Cutter cutter;
  RecordedPath recorded = programmed(machine, cutter);
  constexpr double kOff_mm = 0.02;
  for (JointPose& q : recorded.joints) q.x_mm += kOff_mm;
  const auto points = standard_points();
  const RecordedDeviations found = recorded_deviations(machine, recorded, points, cutter);
  const PartDefect nominal = part_defect(machine, points);
  double largest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    // X moves the tool by that along the table's own x, which is turned by -C in the part.
    const double c = nominal.joints[i].c_deg * M_PI / 180;
    const Eigen::Vector3d shift(kOff_mm * std::cos(c), -kOff_mm * std::sin(c), 0);
    const double expected = shift.dot(nominal.normal.col(static_cast<Eigen::Index>(i)));
    EXPECT_NEAR(found.points[i].controller_mm(), expected, 3e-4) << i;  // contact moves along the flank
    largest = std::max(largest, std::abs(expected));
  }
  EXPECT_GT(largest, 0.015);
  const nlohmann::ordered_json json = recorded_json(found);
  EXPECT_EQ(json["points"], 100);
  EXPECT_NEAR(json["controller"]["max_mm"].get<double>(), largest, 5e-4);
  EXPECT_NE(recorded_csv(points, nominal, found).find("\nA,0.020000,"), std::string::npos);
}

TEST(RecordedPath, IsReadAsRecordWritesItFromItsZero) {
  const RecordedPath read = read_recorded(
      "t[s],X[mm],Y[um],Z[mm],B[deg],C[deg],dirX,run\n0,121,2000,460,1,2,1,a\n0.008,122,3000,461,1,2,1,a\n",
      "record.csv", {120, 0, -40, 0, 0});
  ASSERT_EQ(read.joints.size(), 2u);
  EXPECT_NEAR(read.joints[0].x_mm, 1, 1e-12);
  EXPECT_NEAR(read.joints[0].y_mm, 2, 1e-12);
  EXPECT_NEAR(read.joints[1].z_mm, 501, 1e-12);
  EXPECT_THROW(read_recorded("X[mm],Y[mm],Z[mm],B[deg]\n1,2,3,4\n1,2,3,4\n", "r.csv"), InputError);
  EXPECT_THROW(read_recorded("X[mm],Y[mm],Z[mm],B[mm],C[deg]\n1,2,3,4,5\n1,2,3,4,5\n", "r.csv"), InputError);
  EXPECT_THROW(read_recorded("X[mm],Y[mm],Z[mm],B[deg],C[deg]\n1,2,3,4,5\n", "r.csv"), InputError);
}

TEST(RecordedPath, APartThatWasNotPassedIsRefused) {
  const BHeadMachine machine = part_data::machine();
  RecordedPath recorded = programmed(machine, {});
  recorded.joints.resize(recorded.joints.size() / 2);  // flank A alone
  EXPECT_THROW(recorded_deviations(machine, recorded, standard_points(), {}), InputError);
}

TEST(SplineProgram, HasTheLinesOfTheTables) {
  const std::string foot = spline_program(0, 30), middle = spline_program(11, 25);
  // Table 1 and table 2; of flank B the length is that of its points (s_part.md).
  for (const char* line :
       {"ORICURVE\nG1 G42 X-137 Y-95.5 Z0 XH=-131 YH=-95.5 ZH=30\nBSPLINE SD=3\n",
        "\nX-134 Y-41 Z0 XH=-126 YH=-41 ZH=30 PL=0\n", "\nX-49 Y84 Z0 XH=-51 YH=77 ZH=30 PL=51.407",
        "\nX121 Y99.5 Z0 XH=115 YH=99.5 ZH=30 PL=0\n", "\nG1 X-127 Y-95.5 Z0 XH=-121 YH=-95.5 ZH=30\n",
        "\nX30 Y-95 Z0 XH=26 YH=-88 ZH=30 PL=51.24", " ;arc13\nX131 Y99.5 Z0 XH=125 YH=99.5 ZH=30 PL=0\n"})
    EXPECT_NE(foot.find(line), std::string::npos) << line;
  for (const char* line :
       {"X-134.8 Y-95.5 Z11 XH=-132 YH=-95.5 ZH=25\n", "X-131.067 Y-41 Z11 XH=-127.333 YH=-41 ZH=25 PL=0\n",
        "X-21.9 Y53.6 Z11 XH=-20.5 YH=48 ZH=25 PL=", "X108.067 Y-82.9 Z11 XH=104.333 YH=-81.5 ZH=25 PL=",
        "X-107.633 Y73.067 Z11 XH=-107.167 YH=69.333 ZH=25 PL="})
    EXPECT_NE(middle.find(line), std::string::npos) << line;
}

}  // namespace
}  // namespace vernier::recorded_test
