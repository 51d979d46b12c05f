// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/first_plan.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/plan/bridge.h"
#include "tools/fit/fit.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/chain/work_poses.h"
#include "tools/model/machine_reader.h"
#include "tools/plan/sheets.h"
#include "tools/text/error.h"

namespace vernier::first_plan_test {

using bridge_to_plan::bridge;
using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::plan;
using namespace vernier::text;
namespace {

const FirstPlanOptions kAsked = {.accuracy_um = 6, .reading_um = 3};

TEST(FirstPlan, NeedsFewerPosesThanChance) {
  const Machine machine = bridge();
  const FirstPlan plan = first_plan(machine, kAsked);
  EXPECT_TRUE(plan.reached);
  EXPECT_LE(plan.after_um, 6);
  EXPECT_GT(plan.before_um, 50);
  EXPECT_LT(plan.after_um, 0.95 * plan.random_um);
  EXPECT_GE(plan.references, 1U);
  EXPECT_GT(std::count(plan.check.begin(), plan.check.end(), 1), 0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_GE(plan.states.axis[axis].minCoeff(), *machine.axes[axis].min);
    EXPECT_LE(plan.states.axis[axis].maxCoeff(), *machine.axes[axis].max);
  }
}

TEST(FirstPlan, PromisesWhatAFitThenKeeps) {
  // Machines drawn from what was expected, measured as planned: the tool point's error beside what was
  // promised.
  const Machine machine = bridge();
  const FirstPlan plan = first_plan(machine, kAsked);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 1);
  double squares = 0, count = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Machine truth = machine;
    const ParameterSet parameters(truth, {"first"});
    Eigen::VectorXd values = parameters.get(truth);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const std::string& unit = parameters[i].unit;
      values[static_cast<Eigen::Index>(i)] = normal(random) * (unit == "mm"    ? 0.05
                                                               : unit == "deg" ? 0.005
                                                                               : 1e-4);
    }
    parameters.set(truth, values);
    Measurement rows = parse_measurement(
        [&] {
          std::string text = first_plan_csv(machine, plan, kAsked.reading_um);
          for (std::size_t at = text.find(",,,"); at != std::string::npos; at = text.find(",,,", at))
            text.replace(at, 3, ",0,0,0");
          return text;
        }(),
        "plan.csv", machine);
    const Eigen::VectorXd ideal = predict(truth, rows);
    for (std::size_t i = 0; i < rows.observations.size(); ++i)
      rows.observations[i].value =
          ideal[static_cast<Eigen::Index>(i)] + 1e-3 * kAsked.reading_um * normal(random);
    const FitResult fitted = fit::fit(machine, rows);
    const States fresh = work_poses(machine).states;
    Eigen::Matrix3Xd off = forward(fitted.machine, fresh).position - forward(truth, fresh).position;
    off.colwise() -= off.rowwise().mean().eval();
    squares += off.colwise().squaredNorm().sum();
    count += static_cast<double>(off.cols());
  }
  const double realised_um = 2000 * std::sqrt(squares / count);
  EXPECT_LT(realised_um, 1.4 * plan.after_um);
  EXPECT_GT(realised_um, 0.5 * plan.after_um);
}

TEST(FirstPlan, UncertaintyOfItsOwnPosesIsWhatItSays) {
  const Machine machine = bridge();
  const FirstPlan plan = first_plan(machine, kAsked);
  std::vector<std::size_t> fit;
  for (std::size_t i = 0; i < plan.check.size(); ++i)
    if (plan.check[i] == 0) fit.push_back(i);
  // The first pose comes again, which the plan's own figure does not count.
  const double um = planned_uncertainty_um(machine, select_states(plan.states, fit), kAsked);
  EXPECT_LE(um, plan.after_um * (1 + 1e-9));
  EXPECT_GT(um, 0.9 * plan.after_um);
}

TEST(FirstPlan, GcodeStandsAtEveryPoseFromItsSide) {
  const Machine machine = bridge();
  const FirstPlan plan = first_plan(machine, kAsked);
  const std::string text = poses_gcode(machine, plan.states, "first measurement of bridge");
  std::size_t reads = 0;
  for (std::size_t at = text.find("; read"); at != std::string::npos; at = text.find("; read", at + 1))
    ++reads;
  EXPECT_EQ(reads, plan.check.size());
  EXPECT_NE(text.find("first measurement of bridge"), std::string::npos);
}

TEST(FirstPlan, SaysWhatCannotBeReached) {
  FirstPlanOptions options;
  options.accuracy_um = 1e-3;
  options.most = 30;
  const FirstPlan plan = first_plan(bridge(), options);
  EXPECT_FALSE(plan.reached);
  EXPECT_GT(plan.least_um, 1e-3);
  EXPECT_THROW(first_plan(parse_machine(
                   "<machine><variables><static><a value=\"0\" nominal=\"0\"/></static><machineaxes><X/>"
                   "</machineaxes></variables><transforms><sixdof X=\"X+a\"/></transforms></machine>",
                   "m.xml")),
               InputError);
}

}  // namespace
}  // namespace vernier::first_plan_test
