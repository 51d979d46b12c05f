// SPDX-License-Identifier: GPL-3.0-or-later
// Axes that are fewer than the directions that they reach anywhere: two turns whose tip sweeps a sphere.
#include <gtest/gtest.h>

#include "tests/unit/compile/agreement.h"
#include "tests/unit/compile/left_over.h"

namespace vernier::nearest_test {

using namespace vernier::compile;
using namespace vernier::model;
namespace {

constexpr unsigned kSeed = 131;

/// A telescope seen at 1000 mm: axes tilted and not square, a collimation, indices, a tube that droops, and
/// `radial` mm that no turn takes back.
std::string telescope(double lowest_deg, double highest_deg, double radial) {
  return R"xml(<machine name="telescope"><variables><static>
    <AN value="0.02" nominal="0" unit="deg"/><AW value="-0.015" nominal="0" unit="deg"/>
    <NPAE value="0.01" nominal="0" unit="deg"/><IA value="0.03" nominal="0" unit="deg"/>
    <IE value="-0.02" nominal="0" unit="deg"/><CA value="0.008" nominal="0" unit="deg"/>
    <TF value="0.006" nominal="0" unit="deg"/><R value=")xml" +
         std::to_string(1000 + radial) + R"xml(" nominal="1000" unit="mm"/></static><machineaxes>
    <A rotary="true" min="-180" max="180" maxcorrection="1"/><E rotary="true" min=")xml" +
         std::to_string(lowest_deg) + "\" max=\"" + std::to_string(highest_deg) +
         R"xml(" maxcorrection="1"/></machineaxes></variables><transforms branch="tool">
    <sixdof n="1" rX="AW" rY="AN"/><sixdof n="2" rZ="-(A+IA)"/>
    <sixdof n="3" rX="NPAE" rY="-(E+IE+TF*cos(E))"/><sixdof n="4" rZ="CA"/><sixdof n="5" X="R"/>
    </transforms></machine>)xml";
}

TestMachine mount(double lowest_deg, double highest_deg, double radial) {
  const std::string text = telescope(lowest_deg, highest_deg, radial);
  return TestMachine(parse_machine(text, "m.xml"), text);
}

bool says(const CompiledMachine& compiled, const std::string& part) {
  return std::any_of(compiled.notes.begin(), compiled.notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

TEST(Nearest, ATelescopePointsWhereItIsTold) {
  // GIVEN a mount that keeps away from its pole, and errors that turns can take back
  const TestMachine test = mount(-40, 70, 0);
  // THEN two axes are corrected, and nothing is left but what the bound admits
  EXPECT_EQ(test.compiled.program.outputs.size(), 2u);
  EXPECT_TRUE(says(test.compiled, "move the tool point depend on the pose"));
  EXPECT_FALSE(says(test.compiled, "the correction is reduced"));
  const LeftOver left = left_over(test, 20000, kSeed);
  const double bound = largest_bound_um(test.compiled);
  std::printf("seed %u: %.1f um before, %.5f um left, %.5f um proved, %zu operations\n", kSeed,
              left.before_um, left.left_um, bound, test.compiled.program.instructions.size());
  EXPECT_GT(left.before_um, 500);
  EXPECT_LE(left.left_um, bound);
  EXPECT_LE(bound, 10);  // slopes at their worst, three evaluations
  const Agreement seen = compare(test, 2, 4000, kSeed);
  EXPECT_LE(seen.worst_share, 1);
  EXPECT_GT(seen.worst_um, 1e-7);
  EXPECT_GT(seen.poses, 7900u);
}

TEST(Nearest, WhatLiesAcrossTheAxesStays) {
  // GIVEN 0.2 mm along the tube, which no turn takes back
  const TestMachine test = mount(-40, 70, 0.2);
  const LeftOver left = left_over(test, 5000, kSeed);
  // THEN the nearest point is found, and just this is left
  EXPECT_NEAR(left.left_um, 200, 1);
  EXPECT_LE(compare(test, 2, 2000, kSeed).worst_share, 1);
}

TEST(Nearest, TowardsThePoleTheCorrectionFades) {
  const TestMachine test = mount(0, 90, 0);
  EXPECT_TRUE(says(test.compiled, "the correction is reduced"));
  const Agreement seen = compare(test, 2, 4000, kSeed);
  EXPECT_LE(seen.worst_share, 1);
  EXPECT_GT(seen.poses, 7000u);
  // No pose is made worse than it was, the pole included.
  const LeftOver left = left_over(test, 20000, kSeed);
  EXPECT_LE(left.left_um, left.before_um);
}

}  // namespace
}  // namespace vernier::nearest_test
