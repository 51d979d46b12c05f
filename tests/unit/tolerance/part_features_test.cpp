// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/part_features.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tolerance/plate.h"
#include "tools/kinematics/at.h"
#include "tools/model/chain/chain.h"
#include "tools/text/error.h"
#include "tools/tolerance/placed_part.h"

namespace vernier::tolerance_test {

using namespace vernier::model;
using namespace vernier::text;
using namespace vernier::tolerance;
namespace {

using testing::HasSubstr;

TEST(PartFeatures, AreReadAsTheDrawingHasThem) {
  const PartDrawing part = parse_part(
      "feature,kind,x[m],y,z,nx,ny,nz,i,j,k,diameter,length,width,position,size_low,size_high,form,datum\n"
      "a,cylinder,0.1,2,3,0,0,2,1,0,0,20,8,,0.02,0,0.021,0.005,yes\n"
      "b,point,0,0,0,,,,,,,,,,,,,,no\n",
      "p.csv");
  ASSERT_EQ(part.features.size(), 2u);
  const PartFeature& a = part.features[0];
  EXPECT_DOUBLE_EQ(a.at.x(), 100);  // a metre is a thousand millimetres
  EXPECT_DOUBLE_EQ(a.direction.z(), 1);
  EXPECT_DOUBLE_EQ(a.tool->x(), 1);
  EXPECT_DOUBLE_EQ((*a.size_mm)[1], 0.021);
  EXPECT_TRUE(a.datum);
  EXPECT_EQ(part.features[1].direction.norm(), 0);
  EXPECT_EQ(part.features[1].line, 3u);
}

TEST(PartFeatures, BadOnesAreNamedByLineAndWord) {
  const std::pair<const char*, const char*> kBad[] = {
      {"feature,kind,x,y,z\na,hole,0,0,0\n", "p.csv:2: \"hole\""},
      {"feature,kind,x,y,z\na,cylinder,0,0,0\n", "\"diameter\""},
      {"feature,kind,x,y,z,diameter\na,cylinder,0,0,0,-3\n", "p.csv:2: \"-3\""},
      {"feature,kind,x,y\na,point,0,0\n", "\"z\""},
      {"feature,kind,x,y,z,colour\na,point,0,0,0,red\n", "p.csv:1: \"colour\""},
      {"feature,kind,x[deg],y,z\na,point,0,0,0\n", "\"deg\""},
      {"feature,kind,x,y,z\na,point,0,zero,0\n", "p.csv:2: \"zero\""},
      {"feature,kind,x,y,z\na,point,0,0,0\na,point,1,0,0\n", "p.csv:3: \"a\""},
      {"feature,kind,x,y,z,nx,ny,nz\na,point,0,0,0,0,0,0\n", "\"nx\""},
      {"feature,kind,x,y,z,nx\na,point,0,0,0,1\n", "all three"},
      {"feature,kind,x,y,z,size\na,point,0,0,0,0.1\n", "only a cylinder"},
      {"feature,kind,x,y,z,form\na,point,0,0,0,0.1\n", "no form"},
      {"feature,kind,x,y,z,diameter,size_low,size_high\na,cylinder,0,0,0,5,0.2,0.1\n", "\"0.2\""},
      {"feature,kind,x,y,z,datum\na,point,0,0,0,A\n", "p.csv:2: \"A\""},
      {"feature,kind,x,y,z\n", "p.csv:1"},
  };
  for (const auto& [text, said] : kBad) {
    try {
      parse_part(text, "p.csv");
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(said)) << text;
    }
  }
}

TEST(PartFeatures, TurnThenShift) {
  PartDrawing part = parse_part("feature,kind,x,y,z,nx,ny,nz\na,point,10,0,0,1,0,0\n", "p.csv");
  part = placed_at(part, kinematics::placement("100,200,300,90", "place"));
  EXPECT_NEAR((part.features[0].at - Eigen::Vector3d(100, 210, 300)).norm(), 0, 1e-12);
  EXPECT_NEAR((part.features[0].direction - Eigen::Vector3d(0, 1, 0)).norm(), 0, 1e-12);
}

TEST(PartFeatures, PlaceOfSixDegreesOfFreedomIsASixdofTransform) {
  // By hand: rZ = 90 turns x to y, rX = 90 then turns y to z.
  const Eigen::Isometry3d place = kinematics::placement("1,2,3,90,0,90", "place");
  EXPECT_NEAR((place * Eigen::Vector3d(10, 0, 0) - Eigen::Vector3d(1, 2, 13)).norm(), 0, 1e-12);
  EXPECT_NEAR((place * Eigen::Vector3d(0, 0, 10) - Eigen::Vector3d(1, -8, 3)).norm(), 0, 1e-12);
  EXPECT_THROW(kinematics::placement("1,2,3,4,5", "place"), InputError);
}

TEST(PlacedPart, PointsStandOnTheSurface) {
  const Machine machine = plate_machine(1e-4, 1e-4);
  const PlacedPart part = place_part(machine, parse_part(kBores, "p.csv"), at_rest(machine));
  ASSERT_EQ(part.features.size(), 3u);
  EXPECT_EQ(part.features[1].first, part.features[0].count);
  for (const PlacedFeature& one : part.features)
    for (std::size_t i = one.first; i < one.first + one.count; ++i) {
      const Eigen::Vector3d from = part.point.col(static_cast<Eigen::Index>(i)) - one.feature.at;
      EXPECT_NEAR(from.norm(), 20, 1e-6);  // the solver's tolerance is 1e-9
    }
  // Counter-clockwise: from the first point, at +X, X falls and Y rises.
  EXPECT_EQ(part.states.direction[0][1], -1);
  EXPECT_EQ(part.states.direction[1][1], 1);
}

TEST(PlacedPart, ATiltedToolTurnsTheRotaryAxes) {
  const Machine machine = read_machine(VERNIER_SOURCE_DIR "/tables/machines/five_axis_bhead_ctable.xml");
  const States at = make_states(1, machine);
  const Eigen::Vector3d middle = forward(nominal_machine(machine), at).position.col(0);
  const Eigen::Vector3d tool = Eigen::Vector3d(0.3, 0.2, 1).normalized();
  PartDrawing part =
      parse_part("feature,kind,x,y,z,i,j,k,diameter\na,cylinder,10,20,60,0.3,0.2,1,20\n", "p.csv");
  part = placed_at(part, Eigen::Isometry3d(Eigen::Translation3d(middle)));
  const PlacedPart placed = place_part(machine, part, at);
  const Poses poses = forward(nominal_machine(machine), placed.states);
  for (std::size_t i = 0; i < placed.states.count; ++i) {
    EXPECT_NEAR((poses.rotation[i].col(2) - tool).norm(), 0, 1e-9);  // the solver's tolerance
    EXPECT_NEAR((poses.position.col(static_cast<Eigen::Index>(i)) - part.features[0].at).norm(), 10, 1e-6);
  }
}

TEST(PlacedPart, OutOfReachIsNamedByItsLine) {
  const Machine machine = plate_machine(0, 0);
  const PartDrawing part = parse_part("feature,kind,x,y,z\nnear,point,1,1,-1\nfar,point,700,0,0\n", "p.csv");
  try {
    place_part(machine, part, at_rest(machine));
    FAIL();
  } catch (const LimitNotMet& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.csv:3: \"far\""));
  }
}

}  // namespace
}  // namespace vernier::tolerance_test
