// SPDX-License-Identifier: GPL-3.0-or-later
// Touches of one artefact: each is on it, they determine what the plan promises, and what they cannot is
// said.
#include "tools/plan/touch_plan.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/text/error.h"

namespace vernier::touch_plan_test {

using namespace vernier::plan;
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

model::Machine arm(const std::string& artefacts) {
  return model::parse_machine(R"XML(<machine name="arm"><variables>
  <static><a value="300" nominal="300" unit="mm"/><b value="200" nominal="200" unit="mm"/>
    <zero value="0" nominal="0" unit="deg"/><far value="0" nominal="0" unit="mm"/></static>
  <machineaxes><P rotary="true" min="-170" max="170"/><Q rotary="true" min="-170" max="170"/>
    <R rotary="true" min="-150" max="150"/></machineaxes>)XML" +
                                  artefacts + R"XML(
  </variables><transforms branch="tool"><sixdof n="1" Z="far" rZ="P"/><sixdof n="2" rY="Q"/>
    <sixdof n="3" X="a"/><sixdof n="4" rY="R+zero"/><sixdof n="5" X="b"/></transforms></machine>)XML",
                              "arm.xml");
}

model::Machine mill(const std::string& artefacts) {
  return model::parse_machine(R"XML(<machine name="mill"><variables>
  <static><sq value="0" nominal="0" unit="deg"/><sz value="0" nominal="0" unit="deg"/></static>
  <machineaxes><X min="0" max="500"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes>)XML" +
                                  artefacts + R"XML(
  </variables><transforms branch="tool"><sixdof n="1" X="X-Y*sq*0.0174532925" Y="Y"/>
    <sixdof n="2" X="Z*sz*0.0174532925" Z="Z"/></transforms></machine>)XML",
                              "mill.xml");
}

TEST(TouchPlan, EveryPoseOfASphereIsOnIt) {
  const model::Machine machine =
      mill(R"(<artefact name="ball" type="sphere" radius="50mm" x="200" y="150" z="-150"/>)");
  const TouchPlan plan = touch_plan(machine, "ball");
  ASSERT_GE(plan.states.count, 2U);
  const Eigen::Matrix3Xd points = model::forward(machine, plan.states).position;
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    EXPECT_NEAR((points.col(i) - plan.place_mm).norm(), 50, 1e-6);
  EXPECT_TRUE(plan.has_length);
  EXPECT_FALSE(plan.place_is_assumed);
  EXPECT_LT(plan.after_um, plan.before_um);
  EXPECT_GE(plan.after_um, plan.least_um);
  // All touches are read back by the fit as touches of the ball.
  const model::Measurement rows =
      model::parse_measurement(touch_plan_csv(machine, plan, "ball", 5), "t.csv", machine);
  EXPECT_EQ(rows.rows(), plan.states.count);
}

// One point gives a machine of linear axes one pose only: nothing is determined.
TEST(TouchPlan, APointShowsAMachineOfThreeLinearAxesNothing) {
  const TouchPlan plan = touch_plan(mill(R"(<artefact name="p" type="point"/>)"), "p");
  EXPECT_THAT(plan.not_seen, testing::UnorderedElementsAre("sq", "sz"));
  EXPECT_NEAR(plan.after_um, plan.before_um, 1e-6 * plan.before_um);
  EXPECT_TRUE(plan.place_is_assumed);
  EXPECT_THAT(touch_plan_text(plan, "p"), HasSubstr("do not determine: sq, sz"));
}

// An arm reaches a point elbow up and down, and over its back. A shift of the whole arm stays unseen.
TEST(TouchPlan, APointFromAllPosturesShowsAnArmAllButItsSize) {
  const TouchPlan plan = touch_plan(arm(R"(<artefact name="p" type="point"/>)"), "p");
  EXPECT_FALSE(plan.has_length);
  EXPECT_THAT(plan.not_seen, Contains("far"));
  EXPECT_THAT(plan.not_seen, Not(Contains("zero")));
  EXPECT_THAT(touch_plan_text(plan, "p"), HasSubstr("cannot determine the size of the machine"));
}

TEST(TouchPlan, WhatCannotBePlannedIsNamed) {
  const auto error = [](const model::Machine& machine, const std::string& name) {
    try {
      touch_plan(machine, name);
    } catch (const text::InputError& one) {
      return std::string(one.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(error(mill(""), "p"), HasSubstr("no <artefact>"));
  EXPECT_THAT(error(mill(R"(<artefact name="p" type="point"/>)"), "q"), HasSubstr("but p"));
  EXPECT_THAT(error(mill(R"(<artefact name="p" type="point" x="900" y="0" z="0"/>)"), "p"),
              HasSubstr("no posture"));
}

}  // namespace
}  // namespace vernier::touch_plan_test
