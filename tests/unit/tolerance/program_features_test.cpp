// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/program_features.h"

#include <gtest/gtest.h>

#include "tests/unit/tolerance/plate.h"
#include "tools/text/error.h"

namespace vernier::tolerance_test {

using namespace vernier::model;
using namespace vernier::text;
using namespace vernier::tolerance;
namespace {

PlacedPart read(const Machine& machine, const std::string& text) {
  ProgramOptions options;
  options.zero = {300, 200, -100};
  options.position_mm = 0.05;
  return program_part(machine, text, "p.ngc", at_rest(machine), std::vector<char>(3, 0), options);
}

TEST(ProgramFeatures, CirclesAreCirclesAndTheRestIsPaths) {
  const Machine machine = plate_machine(0, 0);
  const PlacedPart part = read(machine,
                               "G21 G90\nG0 X0 Y0 Z10\nG1 Z0 F300\nG1 X50\nG1 Y20\nG0 Z10\nG0 X10 Y0\nG1 Z0\n"
                               "G2 X10 Y0 I-10 J0\nG0 Z10\n");
  ASSERT_EQ(part.features.size(), 3u);
  EXPECT_EQ(part.features[0].feature.name, "path of lines 3 to 5");
  EXPECT_EQ(part.features[1].feature.name, "path of line 8");  // the way down to the circle
  const PartFeature& circle = part.features[2].feature;
  EXPECT_EQ(circle.name, "circle of line 9");
  EXPECT_EQ(circle.kind, PartFeatureKind::kCylinder);
  EXPECT_NEAR(circle.diameter_mm, 20, 1e-6);
  EXPECT_NEAR((circle.at - Eigen::Vector3d(300, 200, -100)).norm(), 0, 1e-6);
  EXPECT_NEAR(circle.direction.z(), -1, 1e-6);  // clockwise
  EXPECT_DOUBLE_EQ(*circle.position_mm, 0.05);
  // Both senses of X occur on the way round.
  const auto senses = part.states.direction[0].segment(static_cast<Eigen::Index>(part.features[2].first),
                                                       static_cast<Eigen::Index>(part.features[2].count));
  EXPECT_EQ(senses.minCoeff(), -1);
  EXPECT_EQ(senses.maxCoeff(), 1);
}

TEST(ProgramFeatures, AProgramThatCutsNothingIsRefused) {
  EXPECT_THROW(read(plate_machine(0, 0), "G0 X0 Y0 Z0\nG0 X10\n"), InputError);
}

}  // namespace
}  // namespace vernier::tolerance_test
