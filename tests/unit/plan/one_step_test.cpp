// SPDX-License-Identifier: GPL-3.0-or-later
// One change of the machine, when an input changed too: rows at two values of the input do not distinguish
// the two, rows that go back to the first value do.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/unit/plan/confusable.h"
#include "tools/diagnose/diagnosis.h"
#include "tools/effects/add.h"
#include "tools/effects/add_string.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/model/rebind.h"
#include "tools/plan/advice.h"
#include "tools/plan/offers.h"

namespace vernier::plan_test {

using namespace vernier::diagnose;
using namespace vernier::effects;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
namespace {

constexpr std::uint64_t kSeedOfSteps = 7301;

struct Driven {
  std::string heading, id, add;
  double size, low, high;  // size of the unknown: some ten u at the high value
};
const Driven kHeat{
    "T_bed[degC]",
    "thermal-scale",
    "thermal-scale:axis=X,input=T_bed,branch=tool,transform=2,dof=X,reference=20,unit=degC,form=plain",
    4e-6,
    20,
    32};
const Driven kLoad{"load[N]",
                   "load-deflection",
                   "load-deflection:input=load,branch=tool,transform=2,dof=rY,unit=N,form=angle",
                   1.2e-5,
                   0,
                   400};

/// Rows at one value of the input. `acts`: the value with which the machine errs.
struct Leg {
  double recorded, acts;
  std::string run;
};

Diagnosis diagnosis_of(const Driven& driven, const std::vector<Leg>& legs, const DiagnoseOptions& options,
                       Measurement* all = nullptr) {
  const Machine machine = parse_machine(model_text(), "model.xml");
  std::string csv = "X[mm],Y[mm],Z[mm],dirX,t[s]," + driven.heading + ",x[mm],y[mm],z[mm],u[mm],run\n",
              acting = csv;
  std::mt19937_64 random(kSeedOfSteps);
  std::uniform_real_distribution<double> place(0, 1);
  constexpr int kRowsOfLeg = 16;
  int row = 0;
  for (const Leg& leg : legs)
    for (int i = 0; i < kRowsOfLeg; ++i, ++row) {
      const std::string pose =
          fmt::format("{:.1f},{:.1f},{:.1f},{},{},", 600 * place(random), 400 * place(random),
                      -300 * place(random), i % 2 == 0 ? 1 : -1, 20 * row);
      const std::string rest = fmt::format(",0,0,0,{},{}\n", kUncertaintyMm, leg.run);
      csv += pose + fmt::format("{}", leg.recorded) + rest;
      acting += pose + fmt::format("{}", leg.acts) + rest;
    }
  Measurement m = parse_measurement(csv, "survey.csv", machine);
  const Candidate candidate =
      make_candidate(machine, parse_add_string(driven.add, machine, built_in_effects()));
  Machine truth = parse_machine(add_to_machine_text(model_text(), machine, candidate), "truth.xml");
  for (const CandidateUnknown& unknown : linear_unknowns(candidate))
    truth.statics[*truth.find_static(unknown.name)].value = driven.size;
  const Eigen::VectorXd exact =
      predict(truth, rebind(parse_measurement(acting, "survey.csv", machine), machine, truth));
  std::normal_distribution<double> noise(0, kUncertaintyMm);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    m.observations[i].value = exact[static_cast<Eigen::Index>(i)] + noise(random);
  if (all != nullptr) *all = m;
  return diagnose::diagnose(model_text(), machine, m, options);
}

/// The ids of the effects that the diagnosis names: improve adds these.
std::vector<std::string> certain(const Diagnosis& d) {
  std::vector<std::string> ids;
  for (std::size_t i = d.verdict == Verdict::kAmbiguous ? 2 : 1; i < d.ladder.size(); ++i)
    if (d.ladder[i].certain) ids.push_back(d.ladder[i].effect);
  return ids;
}

/// The input of the test: heat or load.
class OneStep : public testing::TestWithParam<int> {
 protected:
  static const Driven& driven() { return GetParam() == 0 ? kHeat : kLoad; }
};

TEST_P(OneStep, OfTheInputAloneIsAmbiguous) {
  const DiagnoseOptions options;
  const double low = driven().low, high = driven().high;
  const std::vector<std::vector<Leg>> surveys = {
      {{low, low, "a"}, {low, low, "b"}, {high, high, "c"}},
      {{low, low, "a"}, {high, high, "b"}, {high, high, "c"}},
      {{low, low, "a"}, {low, low, "a"}, {high, high, "a"}}};  // within one run
  for (const std::vector<Leg>& legs : surveys) {
    Measurement m;
    Diagnosis d = diagnosis_of(driven(), legs, options, &m);
    EXPECT_EQ(d.verdict, Verdict::kAmbiguous) << d.explanation;
    ASSERT_EQ(d.causes.size(), 2U) << d.explanation;
    EXPECT_EQ(d.causes.front().candidate->choice.effect->id, driven().id);
    EXPECT_EQ(d.causes.back().kind, "set-up");
    EXPECT_THAT(d.explanation, HasSubstr("measure again at the first value of the input"));
    const std::vector<std::string> next =
        advice_for(model_text(), parse_machine(model_text(), "model.xml"), m, d, options.effects);
    ASSERT_FALSE(next.empty());
    EXPECT_THAT(next.front(), HasSubstr("Go back to the first value of " +
                                        driven().heading.substr(0, driven().heading.find('[')) +
                                        fmt::format(" ({} ", low)));
  }
}

TEST_P(OneStep, ThatGoesBackNamesTheInput) {
  const DiagnoseOptions options;
  const double low = driven().low, high = driven().high;
  for (const bool one_run : {false, true}) {
    const std::string b = one_run ? "a" : "b", c = one_run ? "a" : "c";
    const Diagnosis d = diagnosis_of(driven(), {{low, low, "a"}, {high, high, b}, {low, low, c}}, options);
    EXPECT_EQ(d.verdict, Verdict::kMissingEffect) << d.explanation;
    EXPECT_THAT(certain(d), testing::ElementsAre(driven().id));
  }
}

TEST_P(OneStep, OfTheMachineInRowsThatGoBackIsNoEffectOfTheInput) {
  const DiagnoseOptions options;
  const double low = driven().low, high = driven().high;
  // The machine changes with the input, or when the input goes back.
  for (const double at_second : {low, high}) {
    const Diagnosis d =
        diagnosis_of(driven(), {{low, low, "a"}, {high, at_second, "b"}, {low, high, "c"}}, options);
    EXPECT_THAT(certain(d), Not(Contains(driven().id))) << d.explanation;
  }
}

INSTANTIATE_TEST_SUITE_P(Inputs, OneStep, testing::Range(0, 2));

/// The planned rows of a heat begin and end at the temperature so far. Without these rows one step explains
/// all readings.
TEST(PlanOfHeat, GoesBackToTheFirstTemperature) {
  const DiagnoseOptions options;
  const Machine machine = parse_machine(model_text(), "model.xml");
  const Confusable pair = confusable_pairs()[1];
  ASSERT_EQ(pair.effects[1], "thermal-scale");
  constexpr double kSoFar = 26;  // degC, of all rows of the survey
  // GIVEN a survey at one temperature
  const Measurement old = survey(pair, 1, machine, kSeedOfSteps);
  // WHEN the next rows are planned
  const Plan plan =
      plan_next(model_text(), machine, old, pair.effects[0], pair.effects[1], built_in_effects());
  // THEN they begin and end at this temperature, and the sentence says so
  const Column temperature = plan.rows.candidates.front().value;
  ASSERT_GE(temperature.size(), 3);
  EXPECT_EQ(temperature[0], kSoFar);
  EXPECT_EQ(temperature[temperature.size() - 1], kSoFar);
  std::vector<std::size_t> away;
  for (std::size_t row = 0; row < plan.rows.rows(); ++row)
    if (std::abs(temperature[static_cast<Eigen::Index>(row)] - kSoFar) > 1) away.push_back(row);
  ASSERT_FALSE(away.empty());
  EXPECT_THAT(plan.sentence, HasSubstr("Begin and end at T_bed 26 degC"));
  EXPECT_THAT(plan.ruled_out, Contains(HasSubstr("one change of the machine")));
  // AND the rows at the other temperatures alone leave the doubt
  Measurement next = plan.rows;
  read(next, machine, pair, 1, kSeedOfSteps + 1);
  const Measurement alone = select_rows(next, away);
  const auto diagnosed = [&](const Measurement& rows) {
    return diagnose::diagnose(model_text(), machine, append_rows(old, rows), options);
  };
  EXPECT_EQ(diagnosed(alone).verdict, Verdict::kAmbiguous) << diagnosed(alone).explanation;
  EXPECT_THAT(certain(diagnosed(next)), testing::ElementsAre("thermal-scale"));
  // AND a change of the machine that does not go back is not named as heat
  Measurement changed = plan.rows;
  for (std::size_t row = away.front(); row < changed.rows(); ++row)
    changed.candidates.front().value[static_cast<Eigen::Index>(row)] =
        temperature[static_cast<Eigen::Index>(away.front())];
  read(changed, machine, pair, 1, kSeedOfSteps + 2);
  changed.candidates.front().value = temperature;
  EXPECT_THAT(certain(diagnosed(changed)), Not(Contains("thermal-scale"))) << diagnosed(changed).explanation;
}

}  // namespace
}  // namespace vernier::plan_test
