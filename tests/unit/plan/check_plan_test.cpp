// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/check_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tools/fit/fit.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/plan/offered_poses.h"
#include "tools/text/error.h"

namespace vernier::check_plan_test {

using namespace vernier::check;
using namespace vernier::model;
using namespace vernier::plan;
using namespace vernier::text;
namespace {

constexpr double kU_mm = 0.002;

Machine model() {
  return parse_machine(R"XML(<machine name="bridge"><variables><static>
    <sxy value="0" nominal="0" unit="rad"/><szx value="0" nominal="0" unit="rad"/><kx value="0" nominal="0"/>
    <bl value="0" nominal="0" unit="mm"/><BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/></static>
    <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" X="X+kx*X+bl*dirX"/><sixdof n="2" Y="Y" X="sxy*Y"/>
    <sixdof n="3" Z="Z" X="szx*Z"/></transforms></machine>)XML",
                       "bridge.xml");
}

/// Readings of a machine at these poses, in a set-up of their own.
Measurement measured(const Machine& truth, const States& states, std::mt19937_64& random) {
  std::string text = pose_rows_csv(truth, states, std::vector<char>(states.count, 0), 1e3 * kU_mm, "a");
  for (std::size_t at = 0; (at = text.find(",,,", at)) != std::string::npos;) text.replace(at, 3, ",0,0,0");
  Measurement m = parse_measurement(text, "rows.csv", truth);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d shift(normal(random), normal(random), normal(random));
  const Eigen::VectorXd exact = predict(truth, m);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    m.observations[i].value = exact[static_cast<Eigen::Index>(i)] + shift[static_cast<Eigen::Index>(i % 3)] +
                              kU_mm * normal(random);
  return m;
}

Machine fitted(std::mt19937_64& random) {
  return fit::fit(model(), measured(model(), offered_poses(model(), 60, 5000), random)).machine;
}

CheckPlanOptions options(std::size_t points = 8) { return {points, 1e3 * kU_mm, 20}; }

TEST(CheckPlan, ShowsTheChangesThatItSays) {
  std::mt19937_64 random(3);
  int told = 0, named = 0, asked = 0;
  for (int k = 0; k < 20; ++k) {
    const Machine machine = fitted(random);
    const CheckPlan plan = check_plan(machine, options());
    ASSERT_EQ(plan.states.count, 8U);
    for (const Shown& one : plan.shows) {
      const auto index = machine.find_static(one.quantity.name);
      if (!index) continue;
      Machine changed = model();
      // Five standard deviations show in half of the cases, a third more in nearly all.
      changed.statics[*index].value += 1.33 * one.change;
      const CheckAnswer answer =
          judge(machine, {record_of(machine, measured(changed, plan.states, random), "now")}, 0.01);
      told += answer.verdict == CheckVerdict::kChanged ? 1 : 0;
      named += !answer.changed.empty() && answer.changed.front().quantity.name == one.quantity.name ? 1 : 0;
      ++asked;
    }
  }
  EXPECT_EQ(asked, 20 * 4);
  EXPECT_GE(told, asked * 9 / 10);
  EXPECT_GE(named, asked * 8 / 10);
}

TEST(CheckPlan, SeesMoreThanAsManyPosesAtRandom) {
  std::mt19937_64 random(4);
  for (int k = 0; k < 5; ++k) {
    const CheckPlan plan = check_plan(fitted(random), options());
    ASSERT_FALSE(plan.shows.empty());
    EXPECT_LT(plan.shows.front().tool_um, plan.random_um);
  }
}

TEST(CheckPlan, MorePosesSeeSmallerChanges) {
  std::mt19937_64 random(5);
  const Machine machine = fitted(random);
  EXPECT_LT(check_plan(machine, options(16)).shows.front().tool_um,
            check_plan(machine, options(8)).shows.front().tool_um);
}

TEST(CheckPlan, SummarisesWhatNoPoseIdentifies) {
  // z0 is the same as a set-up, th turns the tool point about itself.
  const Machine start = parse_machine(R"XML(<machine name="c"><variables><static>
    <z0 value="0" nominal="0" unit="mm"/><th value="0" nominal="0" unit="deg"/><kx value="0" nominal="0"/>
    <BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/></static>
    <machineaxes><X min="0" max="600"/><Y min="0" max="400"/><Z min="-300" max="0"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" X="X+kx*X"/><sixdof n="2" Y="Y"/><sixdof n="3" Z="Z+z0"/>
    <sixdof n="4" rY="90"/><sixdof n="5" X="0.1" rY="th"/><sixdof n="6" X="-0.1*cos(th)" Z="-0.1*sin(th)"/>
    </transforms></machine>)XML",
                                      "c.xml");
  std::mt19937_64 random(6);
  const Machine machine = fit::fit(start, measured(start, offered_poses(start, 60, 5000), random)).machine;
  const CheckPlan plan = check_plan(machine, options());
  EXPECT_THAT(plan.not_seen, testing::IsSupersetOf({"z0", "th"}));
  for (const Shown& one : plan.shows) EXPECT_LT(one.tool_um, 1000) << one.quantity.name;
  const std::string text = check_plan_text(plan, 2);
  EXPECT_THAT(text, testing::HasSubstr(
                        "the check cannot detect a change of these parameters (no motion of the tool point"));
  EXPECT_THAT(text, testing::HasSubstr("z0"));
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 16);
}

TEST(CheckPlan, NeedsAFittedMachine) { EXPECT_THROW(check_plan(model()), InputError); }

}  // namespace
}  // namespace vernier::check_plan_test
