// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/accuracy/accuracy_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/unit/plan/bridge.h"
#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/plan/accuracy/accuracy_aim.h"
#include "tools/plan/offered_poses.h"
#include "tools/text/error.h"

namespace vernier::accuracy_plan_test {

using bridge_to_plan::bridge;
using bridge_to_plan::kBridge;
using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::plan;
using namespace vernier::text;
using namespace vernier::tolerance;
namespace {

constexpr double kU_mm = 0.003;

Machine drawn(std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, 1);
  Machine truth = bridge();
  const ParameterSet parameters(truth, {});
  Eigen::VectorXd values = parameters.get(truth);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = normal(random) * (parameters[i].unit == "mm"    ? 0.03
                                                             : parameters[i].unit == "deg" ? 0.003
                                                                                           : 5e-5);
  parameters.set(truth, values);
  return truth;
}

Measurement read_at(const Machine& truth, const States& poses, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, kU_mm);
  Measurement rows = point_readings(poses);
  rows.uncertainty = Column::Constant(static_cast<Eigen::Index>(poses.count), kU_mm);
  const Eigen::VectorXd ideal = predict(truth, rows);
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    rows.observations[i].value = ideal[static_cast<Eigen::Index>(i)] + normal(random);
  return rows;
}

/// A machine of which thirty poses were measured.
struct AtHand {
  explicit AtHand(std::uint64_t seed) : random(seed) {
    truth = drawn(random);
    rows = read_at(truth, offered_poses(bridge(), 30, 300), random);
    knowledge = knowledge_of(fit::fit(bridge(), rows), rows);
  }
  std::mt19937_64 random;
  Machine truth;
  Measurement rows;
  Knowledge knowledge;
};

AccuracyAim corner() { return {"a corner", {}, {{0, 0, 200}, {1, 0, 150}, {2, -100, 0}}, {}}; }

AccuracyPlan halved(const Knowledge& knowledge, const AccuracyAim& aim) {
  AccuracyOptions options;
  options.accuracy_um = 0.5 * expected_accuracy_um(knowledge, aim, offered_poses(knowledge.machine, 1, 0));
  return accuracy_plan(knowledge, aim, options);
}

/// Of (k = 2) the fitted machine's error over the corner but for a rigid motion, um^2.
double error_square(const Machine& fitted, const Machine& truth) {
  const States fresh = offered_poses(with_region(bridge(), corner().region), 100, 900);
  const Eigen::Matrix3Xd off = forward(fitted, fresh).position - forward(truth, fresh).position;
  const Eigen::MatrixXd motions = rigid_motions(forward(fitted, fresh).position);
  Eigen::VectorXd rest = off.reshaped();
  rest -= motions * maths::least_squares(motions, rest);
  return 4e6 * rest.squaredNorm() / static_cast<double>(off.cols());
}

TEST(AccuracyPlan, StopsWhereTheAccuracyIsReachedAndNotBefore) {
  const AtHand at_hand(1);
  const AccuracyPlan plan = halved(at_hand.knowledge, corner());
  ASSERT_TRUE(plan.reached);
  ASSERT_GT(plan.steps.size(), 2u);
  EXPECT_EQ(plan.steps.front().points, 0u);
  EXPECT_EQ(plan.steps.back().points, plan.states.count);
  EXPECT_DOUBLE_EQ(plan.steps.back().u95_um, plan.after_um);
  AccuracyOptions fewer;
  fewer.accuracy_um = plan.after_um;
  fewer.most = plan.states.count - 1;
  EXPECT_FALSE(accuracy_plan(at_hand.knowledge, corner(), fewer).reached);
  for (std::size_t i = 1; i < plan.steps.size(); ++i) {
    EXPECT_LT(plan.steps[i].u95_um, plan.steps[i - 1].u95_um);
    EXPECT_GT(plan.steps[i].minutes, plan.steps[i - 1].minutes);
  }
}

TEST(AccuracyPlan, NeedsFewerPosesThanChance) {
  AtHand at_hand(2);
  const AccuracyPlan plan = halved(at_hand.knowledge, corner());
  States anywhere = offered_poses(at_hand.knowledge.machine, 3 * plan.states.count / 2, 50000);
  for (std::size_t a = 0; a < 3; ++a)  // evenly drawn: none of them at the ends on purpose
    for (double& q : anywhere.axis[a]) {
      const auto range = *work_range(at_hand.knowledge.machine, a);
      q = std::uniform_real_distribution<double>(range[0], range[1])(at_hand.random);
    }
  EXPECT_GT(expected_accuracy_um(at_hand.knowledge, corner(), anywhere), plan.after_um);
  EXPECT_GT(plan.random_um, plan.after_um);
}

TEST(AccuracyPlan, SaysOfItsOwnPosesWhatItSaidBefore) {
  const AtHand at_hand(3);
  const AccuracyPlan plan = halved(at_hand.knowledge, corner());
  // One by one and all at once are the same but for rounding.
  EXPECT_NEAR(expected_accuracy_um(at_hand.knowledge, corner(), plan.states), plan.after_um,
              1e-6 * plan.after_um);
}

TEST(AccuracyPlan, IsKeptByAFitOfAllRows) {
  double promised = 0, kept = 0;
  for (std::uint64_t seed = 10; seed < 30; ++seed) {
    AtHand at_hand(seed);
    const AccuracyPlan plan = halved(at_hand.knowledge, corner());
    Measurement all = at_hand.rows;
    append_measurement(all, read_at(at_hand.truth, plan.states, at_hand.random));
    const Machine fitted = fit::fit(bridge(), all).machine;
    promised += plan.after_um * plan.after_um;
    kept += error_square(fitted, at_hand.truth);
  }
  // Twenty machines of some six parameters that count: their rms is told to a sixth.
  EXPECT_NEAR(std::sqrt(promised / kept), 1, 0.25);
}

TEST(AccuracyPlan, IsKeptInASetUpThatNothingIsKnownOf) {
  std::string text = kBridge;
  text.replace(text.find("<BaseShift/>"), 12, "<BaseShift run=\"first\"/><BaseShift run=\"accuracy\"/>");
  const Machine machine = parse_machine(text, "m.xml");
  double promised = 0, kept = 0;
  for (std::uint64_t seed = 40; seed < 60; ++seed) {
    std::mt19937_64 random(seed);
    Machine truth = drawn(random);
    truth.base_shifts = machine.base_shifts;
    truth.base_shifts[1].value = {40, -30, 5, 0.1, -0.2, 15};  // the instrument stands somewhere else
    States at = offered_poses(machine, 30, 300);
    make_one_run(at, "first");
    Measurement all = read_at(truth, at, random);
    const Knowledge knowledge = knowledge_of(fit::fit(machine, all), all);
    ASSERT_TRUE(knowledge.new_set_up);
    AccuracyPlan plan = halved(knowledge, corner());
    make_one_run(plan.states, kAccuracyRun);
    append_measurement(all, read_at(truth, plan.states, random));
    const Machine fitted = fit::fit(machine, all).machine;
    promised += plan.after_um * plan.after_um;
    kept += error_square(fitted, truth);
  }
  EXPECT_NEAR(std::sqrt(promised / kept), 1, 0.25);  // as above
}

TEST(AccuracyPlan, SaysWhatSuchReadingsCannotTell) {
  AtHand at_hand(4);
  // As if nothing were known of two parameters, and X were read alone.
  for (const char* name : {"table.Y[200].Z", "kx"})
    for (std::size_t i = 0; i < at_hand.knowledge.parameters.size(); ++i)
      if (at_hand.knowledge.parameters[i].name == name) {
        const auto at = static_cast<Eigen::Index>(i);
        at_hand.knowledge.covariance.row(at).setZero();
        at_hand.knowledge.covariance.col(at).setZero();
        at_hand.knowledge.covariance(at, at) = std::string(name) == "kx" ? 1e-8 : 1e-2;
      }
  at_hand.knowledge.reads = {true, false, false};
  AccuracyOptions options;
  options.accuracy_um = 5;
  const AccuracyPlan plan = accuracy_plan(at_hand.knowledge, {"the volume", {}, {}, {}}, options);
  EXPECT_FALSE(plan.reached);
  EXPECT_GT(plan.floor_um, 5);
  ASSERT_FALSE(plan.unseen.empty());
  EXPECT_EQ(plan.unseen[0].name, "straightness of Y in Z");
}

TEST(AccuracyPlan, OfAPartIsForItsFeatures) {
  const AtHand at_hand(5);
  const PartDrawing drawing = parse_part(
      "feature,kind,x,y,z,diameter,position,datum\na,cylinder,50,50,-50,20,,yes\nb,cylinder,200,50,-50,20,,"
      "yes\n"
      "c,cylinder,100,150,-50,20,0.01,\n",
      "p.csv");
  AccuracyAim aim;
  aim.part = place_part(at_hand.knowledge.machine, drawing,
                        make_states(1, at_hand.knowledge.machine.axes.size(), {}));
  const AccuracyPlan plan = halved(at_hand.knowledge, aim);
  ASSERT_TRUE(plan.reached);
  std::vector<std::string> names;
  for (const AccuracyOf& one : plan.parts) {
    names.push_back(one.name);
    EXPECT_LE(one.after_um, one.now_um);
  }
  EXPECT_THAT(names, testing::Contains("position of c"));
}

TEST(AccuracyPlan, ForALongerToolThereIsMoreToKnow) {
  const AtHand at_hand(7);
  const States none = select_states(offered_poses(bridge(), 1, 0), {});
  AccuracyAim aim = corner();
  const double own = expected_accuracy_um(at_hand.knowledge, aim, none);
  aim.tooled = with_tool(at_hand.knowledge.machine, {0, 400, 0});  // rZ of the Y carriage moves it
  EXPECT_GT(expected_accuracy_um(at_hand.knowledge, aim, none), 1.05 * own);
}

TEST(AccuracyPlan, KnowsAFittedFileAsItsFitDoes) {
  AtHand at_hand(6);
  const FitResult fitted = fit::fit(bridge(), at_hand.rows);
  const Knowledge file = knowledge_of(fitted.machine);
  EXPECT_TRUE(file.new_set_up);
  const States none = select_states(offered_poses(bridge(), 1, 0), {});
  // The file keeps seven digits of the covariance.
  EXPECT_NEAR(expected_accuracy_um(file, corner(), none),
              expected_accuracy_um(knowledge_of(fitted, at_hand.rows), corner(), none), 1e-3);
  EXPECT_THROW(knowledge_of(bridge()), InputError);
}

}  // namespace
}  // namespace vernier::accuracy_plan_test
