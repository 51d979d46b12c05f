// SPDX-License-Identifier: GPL-3.0-or-later
// Motion state derived from a path, against the closed forms of simple motions.
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <cmath>

#include "tools/model/machine_reader.h"
#include "tools/simulate/motion.h"
#include "tools/simulate/path.h"
#include "tools/text/error.h"

namespace vernier::motion_test {

using namespace vernier::model;
using namespace vernier::simulate;
using namespace vernier::text;
namespace {

Machine machine() {
  return parse_machine(R"xml(<machine name="m"><variables>
    <machineaxes><X rotary="false"/><Y rotary="false"/><C rotary="true"/></machineaxes>
    <inputs><T unit="degC" reference="20"/><U unit="mm" reference="7"/></inputs></variables>
    <transforms><sixdof n="1" X="X" Y="Y" Z="0" rX="0" rY="0" rZ="C"/></transforms></machine>)xml",
                       "m.xml");
}

States states_of(const std::string& text) {
  const Path path(text, "path.csv");
  return path_states(path, machine(), ticks_of(path, 1e-3));
}

TEST(PathStates, PolylineHasSlopesSensesAndTravels) {
  // X: rest 0.1 s, 10 mm in 0.1 s, rest 0.1 s, back 5 mm in 0.1 s, rest.
  const States s = states_of(
      "t[s],X[mm],Y[mm],C[deg]\n0,0,0,0\n0.1,0,0,0\n0.2,10,0,36\n0.3,10,0,36\n0.4,5,0,36\n0.5,5,0,36\n");
  const auto at = [](double t) { return static_cast<Eigen::Index>(std::lround(1000 * t)); };
  EXPECT_EQ(s.count, 501u);
  EXPECT_EQ(s.direction[0][at(0.05)], 0) << "no motion yet";
  EXPECT_EQ(s.direction[0][at(0.15)], 1);
  EXPECT_EQ(s.direction[0][at(0.25)], 1) << "held at rest";
  EXPECT_EQ(s.direction[0][at(0.35)], -1);
  EXPECT_EQ(s.direction[0][at(0.45)], -1);
  EXPECT_NEAR(s.velocity[0][at(0.15)], 100, 1e-9);
  EXPECT_EQ(s.velocity[0][at(0.25)], 0);
  EXPECT_NEAR(s.velocity[0][at(0.35)], -50, 1e-9);
  EXPECT_NEAR(s.velocity[2][at(0.15)], 360, 1e-9);
  EXPECT_EQ(s.since[0][at(0.25)], kLongWay) << "no reversal yet";
  EXPECT_NEAR(s.since[0][at(0.35)], 2.5, 1e-9);
  EXPECT_NEAR(s.since[0][at(0.45)], 5, 1e-9);
  EXPECT_NEAR(s.feed[at(0.15)], 6000, 1e-6) << "the rotary axis has no part in the feed";
  EXPECT_EQ(s.direction[1].abs().maxCoeff(), 0);
  EXPECT_EQ(s.since[1].minCoeff(), kLongWay);
}

TEST(PathStates, AccelerationIsTheChangeOfSpeedAtTheRows) {
  // Constant acceleration 200 mm/s^2, rows every 10 ms: exact at inner rows and between them.
  std::string text = "t[s],X[mm],Y[mm],C[deg]\n";
  for (int i = 0; i <= 100; ++i) text += fmt::format("{},{},1,2\n", 0.01 * i, 100 * 1e-4 * i * i);
  const States s = states_of(text);
  for (Eigen::Index k = 0; k < s.acceleration[0].size(); ++k)
    ASSERT_NEAR(s.acceleration[0][k], 200, 1e-6) << k;
  EXPECT_EQ(s.acceleration[1].abs().maxCoeff(), 0);
}

TEST(PathStates, CircleHasItsCurvatureAndFeed) {
  constexpr double kRadius = 50, kRate = 2;  // mm, rad/s
  std::string text = "t[s],X[mm],Y[mm],C[deg]\n";
  for (int i = 0; i <= 3000; ++i)
    text += fmt::format("{},{},{},0\n", 1e-3 * i, kRadius * std::cos(kRate * 1e-3 * i),
                        kRadius * std::sin(kRate * 1e-3 * i));
  const States s = states_of(text);
  // A chord of 2e-3 rad is shorter than its arc by 1.7e-7 of it; curvature from second differences alike.
  EXPECT_NEAR(s.feed.maxCoeff(), 60 * kRadius * kRate, 0.01);
  EXPECT_NEAR(s.feed.minCoeff(), 60 * kRadius * kRate, 0.01);
  EXPECT_NEAR(s.curvature.maxCoeff(), 1 / kRadius, 1e-7);
  EXPECT_NEAR(s.curvature.minCoeff(), 1 / kRadius, 1e-7);
  EXPECT_NEAR(s.acceleration[0][0], -kRadius * kRate * kRate, 0.5);
}

TEST(PathStates, WhatThePathHasIsTakenFromIt) {
  const States s = states_of(
      "t[s],X[mm],Y[mm],C[deg],vX[m/s],aX[m/s^2],dirX,sinceX[mm],feed[mm/min],curv[1/mm],T[K],U[um],visit\n"
      "0,0,0,0,1,4,-1,3,600,0.1,293.15,1000,5\n0.01,0,0,0,2,8,1,5,1200,0.3,303.15,2000,6\n");
  EXPECT_NEAR(s.velocity[0][5], 1500, 1e-6);
  EXPECT_NEAR(s.acceleration[0][5], 6000, 1e-6);
  EXPECT_EQ(s.direction[0][5], -1) << "a sense is held, not averaged";
  EXPECT_EQ(s.direction[0][10], 1);
  EXPECT_NEAR(s.since[0][5], 4, 1e-9);
  EXPECT_NEAR(s.feed[5], 900, 1e-9);
  EXPECT_NEAR(s.curvature[5], 0.2, 1e-9);
  EXPECT_NEAR(s.input[0][5], 25, 1e-9) << "K to the degC of the machine";
  EXPECT_NEAR(s.input[1][5], 1.5, 1e-9) << "um to the mm of the machine";
  EXPECT_EQ(s.visit[5], 5);
}

TEST(PathStates, MissingInputTakesItsReferenceAndUnknownColumnsAreIgnored) {
  const States s = states_of(
      "t[s],X[mm],Y[mm],C[deg],length[mm],role,run\n0,0,0,0,100,fit,a\n0.01,1,0,0,,check,b\n0.02,1,0,0,,,"
      "b\n");
  EXPECT_EQ(s.input[0][3], 20);
  EXPECT_EQ(s.input[1][3], 7);
  EXPECT_EQ(s.run_names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(s.run[3], 0u);
  EXPECT_EQ(s.run[13], 1u);
}

TEST(PathStates, MissingAxisAndWrongUnitsAreNamed) {
  EXPECT_THROW(states_of("t[s],X[mm],Y[mm]\n0,0,0\n"), InputError);
  EXPECT_THROW(states_of("t[s],X[deg],Y[mm],C[deg]\n0,0,0,0\n"), InputError);
  EXPECT_THROW(states_of("t[s],X[mm],Y[mm],C[deg],dirX\n0,0,0,0,0.5\n"), InputError);
  EXPECT_THROW(states_of("t[s],X[mm],Y[mm],C[deg],T[mm]\n0,0,0,0,1\n"), InputError);
  EXPECT_THROW(states_of("t[s],X[mm],Y[mm],C[deg]\n0,0,,0\n"), InputError);
}

TEST(PathStates, StandingMachineHasNoMotion) {
  const States s = states_of("t[s],X[mm],Y[mm],C[deg]\n0,5,6,7\n");
  EXPECT_EQ(s.count, 1u);
  EXPECT_EQ(s.velocity[0][0], 0);
  EXPECT_EQ(s.acceleration[0][0], 0);
  EXPECT_EQ(s.feed[0], 0);
  EXPECT_EQ(s.curvature[0], 0);
}

}  // namespace
}  // namespace vernier::motion_test
