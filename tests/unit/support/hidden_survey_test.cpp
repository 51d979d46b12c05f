// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/hidden_survey_key.h"
#include "tools/fit/fit.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"

namespace vernier::support {

using namespace vernier::fit;
using namespace vernier::model;
namespace {

constexpr std::uint64_t kSeed = 20260101;

SurveySpec spec_of(Family family, const std::string& effect = "", SurveyClass kind = SurveyClass::kSingle) {
  SurveySpec spec;
  spec.family = family;
  spec.effect = effect;
  spec.kind = kind;
  spec.seed = kSeed;
  return spec;
}

Measurement measured(const HiddenSurvey& survey, const Machine& machine) {
  return parse_measurement(survey.csv, "survey.csv", machine);
}

/// Weighted rms of a fit's residual over the fit rows, in units of u.
double left_over(const FitResult& result) {
  return std::sqrt(result.chi_square / static_cast<double>(result.before.count));
}

/// The same rows with the readings of `machine`, without noise.
Measurement without_noise(const HiddenSurvey& survey, const Machine& machine) {
  Measurement m = measured(survey, machine);
  const Eigen::VectorXd exact = predict(machine, m);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    m.observations[i].value = exact[static_cast<Eigen::Index>(i)];
  return m;
}

class HiddenSurveyOf : public ::testing::TestWithParam<Family> {};

// The second derivation of the ratio: what a nonlinear fit of the user's model leaves of exact readings.
TEST_P(HiddenSurveyOf, LeavesTheRatioAskedForAfterAFit) {
  for (const double ratio : {2.0, 0.5}) {
    SurveySpec spec = spec_of(GetParam());
    spec.ratio = ratio;
    const HiddenSurvey survey = make_survey(spec);
    SCOPED_TRACE(key_of(survey));
    const Machine truth = parse_machine(survey.truth, "truth.xml");
    const Machine model = parse_machine(survey.model, "model.xml");
    Measurement m = measured(survey, model);
    const Measurement exact = without_noise(survey, truth);
    for (std::size_t i = 0; i < m.observations.size(); ++i)
      m.observations[i].value = exact.observations[i].value;
    EXPECT_NEAR(left_over(fit::fit(model, m)), ratio, 0.05 * ratio);
  }
}

TEST_P(HiddenSurveyOf, IsTheModelOnceTheTermIsZero) {
  const HiddenSurvey survey = make_survey(spec_of(GetParam()));
  SCOPED_TRACE(key_of(survey));
  Machine truth = parse_machine(survey.truth, "truth.xml");
  for (const std::string& name : survey.effects.at(0).statics) {
    ASSERT_TRUE(truth.find_static(name)) << name;
    EXPECT_NE(truth.statics[*truth.find_static(name)].value, 0);
    truth.statics[*truth.find_static(name)].value = 0;
  }
  const Machine model = parse_machine(survey.model, "model.xml");
  Measurement m = measured(survey, model);
  const Measurement exact = without_noise(survey, truth);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    m.observations[i].value = exact.observations[i].value;
  // Of u: what the convention's pull leaves of readings without noise, in directions known to about their
  // scale.
  EXPECT_LT(left_over(fit::fit(model, m)), 0.05);
}

TEST_P(HiddenSurveyOf, CanShowEachOfItsEffects) {
  for (const std::string& effect : effects_of(GetParam())) {
    SCOPED_TRACE(effect);
    const HiddenSurvey survey = make_survey(spec_of(GetParam(), effect));
    ASSERT_EQ(survey.effects.size(), 1U);
    const HiddenEffect& hidden = survey.effects[0];
    EXPECT_EQ(hidden.cause.effect, effect);
    EXPECT_NEAR(hidden.ratio, 2, 0.1);
    EXPECT_EQ(hidden.accept.at(0), hidden.cause);
    const Machine truth = parse_machine(survey.truth, "truth.xml");
    EXPECT_NO_THROW(parse_expression_for(truth, hidden.term)) << hidden.term;
    for (const std::string& input : hidden.inputs) EXPECT_TRUE(truth.find_input(input)) << input;
  }
}

TEST_P(HiddenSurveyOf, WithNothingHiddenLeavesOnlyNoise) {
  const HiddenSurvey survey = make_survey(spec_of(GetParam(), "", SurveyClass::kNoise));
  EXPECT_TRUE(survey.effects.empty());
  const Machine model = parse_machine(survey.model, "model.xml");
  const FitResult result = fit::fit(model, measured(survey, model));
  const auto freedom = static_cast<double>(result.freedom);
  EXPECT_NEAR(result.chi_square / freedom, 1, 5 * std::sqrt(2 / freedom));  // five sigma of chi^2
}

TEST_P(HiddenSurveyOf, HidesWhatNoCatalogueHolds) {
  const HiddenSurvey survey = make_survey(spec_of(GetParam(), "", SurveyClass::kOutside));
  ASSERT_EQ(survey.effects.size(), 1U);
  EXPECT_EQ(survey.effects[0].cause.effect.substr(0, 8), "outside:");
  EXPECT_NEAR(survey.effects[0].ratio, 2, 0.1);
}

TEST_P(HiddenSurveyOf, HidesTwoAtOnce) {
  const HiddenSurvey survey = make_survey(spec_of(GetParam(), "", SurveyClass::kTwo));
  ASSERT_EQ(survey.effects.size(), 2U);
  EXPECT_NE(survey.effects[0].cause, survey.effects[1].cause);
  EXPECT_NEAR(survey.effects[1].ratio, 2, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Families, HiddenSurveyOf,
                         ::testing::Values(Family::kBridge, Family::kColumn, Family::kGantry,
                                           Family::kHorizontalArm, Family::kFiveAxis, Family::kFibre,
                                           Family::kRobot, Family::kBallBar, Family::kSingleAxis),
                         [](const auto& family) {
                           std::string name = family_name(family.param);
                           std::erase(name, '-');
                           return name;
                         });

TEST(HiddenSurvey, IsTheSameForASeedAndAnotherForTheNext) {
  SurveySpec spec = spec_of(Family::kFiveAxis);
  const HiddenSurvey one = make_survey(spec), again = make_survey(spec);
  EXPECT_EQ(one.truth, again.truth);
  EXPECT_EQ(one.model, again.model);
  EXPECT_EQ(one.csv, again.csv);
  EXPECT_EQ(key_of(one), key_of(again));
  ++spec.seed;
  EXPECT_NE(one.csv, make_survey(spec).csv);
}

// Sense and travel must be what the order of the rows says, or `backlash` would be hidden in made-up columns.
TEST(HiddenSurvey, RecordsTheSenseThatTheOrderOfItsRowsHas) {
  SurveySpec spec = spec_of(Family::kBridge, "backlash");
  for (; spec.seed < kSeed + 50; ++spec.seed) {
    const HiddenSurvey survey = make_survey(spec);
    if (survey.csv.find("curv") != std::string::npos) continue;  // on the fly: arcs turn between two rows
    const Measurement m = measured(survey, parse_machine(survey.model, "model.xml"));
    for (std::size_t a = 0; a < 3; ++a)
      for (Eigen::Index i = 1; i < static_cast<Eigen::Index>(m.rows()); ++i) {
        const double by = m.states.axis[a][i] - m.states.axis[a][i - 1];
        const double sense = by > 0 ? 1 : by < 0 ? -1 : m.states.direction[a][i - 1];
        ASSERT_EQ(m.states.direction[a][i], sense) << "axis " << a << " row " << i;
        const double since =
            (sense == m.states.direction[a][i - 1] ? m.states.since[a][i - 1] : 0) + std::abs(by);
        ASSERT_NEAR(m.states.since[a][i], since, 2e-4);  // two roundings of the file
      }
    return;
  }
  FAIL() << "no survey at rest in fifty seeds";
}

// Speed against the difference of positions: a survey on the fly samples a motion that can be.
TEST(HiddenSurvey, MovesAsFastAsItSays) {
  const HiddenSurvey survey = make_survey(spec_of(Family::kGantry, "servo-lag"));
  const Measurement m = measured(survey, parse_machine(survey.model, "model.xml"));
  std::size_t compared = 0;
  for (Eigen::Index i = 1; i < static_cast<Eigen::Index>(m.rows()); ++i) {
    const double dt = m.states.time[i] - m.states.time[i - 1];
    for (std::size_t a = 0; a < 3; ++a) {
      const double v = m.states.velocity[a][i], before = m.states.velocity[a][i - 1];
      const double acceleration = m.states.acceleration[a][i];
      if (v == 0 || std::abs(v - before) > 1e-9 || std::abs(acceleration) > 1e-9) continue;
      EXPECT_NEAR(m.states.axis[a][i] - m.states.axis[a][i - 1], v * dt,
                  2e-3 * std::abs(v) + 2e-3);  // ms, um
      ++compared;
    }
  }
  EXPECT_GT(compared, 20U);
}

TEST(HiddenSurvey, CannotTellWhatIsConfusableByDesign) {
  for (const Family family : {Family::kBridge, Family::kGantry, Family::kFiveAxis}) {
    const HiddenSurvey survey = make_survey(spec_of(family, "", SurveyClass::kConfusable));
    ASSERT_FALSE(survey.alternatives.empty());
    EXPECT_LE(survey.alternatives[0].excess, 2);
    EXPECT_FALSE(survey.can_tell);
  }
}

TEST(HiddenSurvey, CannotTellTheDelayOfATriggerFromAConstantAtOneFeed) {
  SurveySpec spec = spec_of(Family::kBridge, "trigger-delay");
  spec.feeds = 3;
  EXPECT_GT(make_survey(spec).alternatives.at(0).excess, 1);
  spec.feeds = 1;
  const HiddenSurvey survey = make_survey(spec);
  EXPECT_FALSE(survey.can_tell);
  EXPECT_NEAR(survey.alternatives.at(0).excess, 0, 1e-6);
  EXPECT_TRUE(survey.alternatives[0].cause.effect == "tool-radius" ||
              survey.alternatives[0].cause.effect == "probe-pretravel")
      << survey.alternatives[0].cause.effect;
}

// An alternative's excess is claimed from linear columns: the fits themselves must agree.
TEST(HiddenSurvey, TellsByChiSquareWhatFitsTell) {
  const HiddenSurvey survey = make_survey(spec_of(Family::kFiveAxis, "backlash"));
  ASSERT_TRUE(survey.can_tell);
  const Machine truth = parse_machine(survey.truth, "truth.xml");
  const Machine model = parse_machine(survey.model, "model.xml");
  const FitResult with = fit::fit(truth, measured(survey, truth)),
                  without = fit::fit(model, measured(survey, model));
  EXPECT_NEAR(with.chi_square / static_cast<double>(with.freedom), 1, 5 * std::sqrt(2.0 / 900));
  // N * ratio^2 is what the term explains, within five times the spread 2 * ratio * sqrt(N).
  const auto n = static_cast<double>(with.before.count);
  EXPECT_NEAR(without.chi_square - with.chi_square, 4 * n, 20 * std::sqrt(n));
}

TEST(HiddenSurvey, RefusesWhatTheFamilyCannotShow) {
  EXPECT_THROW(make_survey(spec_of(Family::kSingleAxis, "lateral-play")), std::runtime_error);
  EXPECT_THROW(make_survey(spec_of(Family::kBridge, "no-such-effect")), std::runtime_error);
}

TEST(HiddenSurvey, WritesItsKey) {
  const auto key = nlohmann::json::parse(key_of(make_survey(spec_of(Family::kRobot, "joint-compliance"))));
  EXPECT_EQ(key["family"], "robot");
  EXPECT_EQ(key["effects"][0]["accept"][0]["effect"], "joint-compliance");
  EXPECT_TRUE(key["effects"][0]["input"].is_null());
}

}  // namespace
}  // namespace vernier::support
