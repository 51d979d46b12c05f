// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/bench/diagnose/answer.h"
#include "tests/bench/diagnose/rates.h"

namespace vernier::bench {
namespace {

using support::HiddenEffect;
using support::HiddenSurvey;
using support::SurveyClass;

HiddenSurvey survey_hiding(const std::vector<support::Cause>& causes,
                           SurveyClass kind = SurveyClass::kSingle) {
  HiddenSurvey survey;
  survey.spec.kind = kind;
  for (const support::Cause& cause : causes) {
    HiddenEffect effect;
    effect.cause = cause;
    effect.accept = {cause};
    if (!cause.input.empty()) effect.inputs = {cause.input};
    survey.effects.push_back(effect);
  }
  return survey;
}

nlohmann::json list(std::initializer_list<nlohmann::json> items) {
  nlohmann::json array = nlohmann::json::array();
  for (const nlohmann::json& item : items) array.push_back(item);
  return array;
}

nlohmann::json candidate(const char* effect, const char* axis, const char* input,
                         const std::vector<std::string>& confounded = {}) {
  const auto or_null = [](const char* s) { return *s == 0 ? nlohmann::json() : nlohmann::json(s); };
  return {{"effect", effect}, {"axis", or_null(axis)}, {"input", or_null(input)},
          {"term", "k"},      {"add", effect},         {"confounded_with", confounded}};
}

Outcome outcome(const HiddenSurvey& survey, const char* verdict, const nlohmann::json& candidates,
                const nlohmann::json& ladder = nlohmann::json::array()) {
  return judge(survey,
               nlohmann::json{{"verdict", verdict}, {"candidates", candidates}, {"ladder", ladder}}.dump())
      .outcome;
}

TEST(DiagnoseAnswer, DemandsEffectAxisAndInput) {
  const HiddenSurvey survey = survey_hiding({{"thermal-scale", "X", "T1"}});
  EXPECT_EQ(outcome(survey, "missing-effect", list({candidate("thermal-scale", "X", "T1")})),
            Outcome::kRight);
  EXPECT_EQ(outcome(survey, "missing-effect", list({candidate("thermal-scale", "Y", "T1")})),
            Outcome::kWrong);
  EXPECT_EQ(outcome(survey, "missing-effect", list({candidate("thermal-scale", "X", "T2")})),
            Outcome::kWrong);
  EXPECT_EQ(outcome(survey, "missing-effect", list({candidate("thermal-offset", "X", "T1")})),
            Outcome::kWrong);
  EXPECT_EQ(outcome(survey, "consistent", nlohmann::json::array()), Outcome::kConsistent);
}

TEST(DiagnoseAnswer, LooksForTheCauseAmongThoseThatNameEachOther) {
  const HiddenSurvey survey = survey_hiding({{"backlash", "X", ""}});
  const auto lag = candidate("servo-lag", "X", "", {"backlash"}),
             play = candidate("backlash", "X", "", {"servo-lag"}), alone = candidate("backlash", "X", "");
  EXPECT_EQ(outcome(survey, "ambiguous", list({lag, play})), Outcome::kAmbiguous);
  EXPECT_EQ(outcome(survey, "ambiguous", list({lag, alone})), Outcome::kAmbiguousMiss);
}

TEST(DiagnoseAnswer, TakesTwoEffectsFromTheLadder) {
  const HiddenSurvey survey =
      survey_hiding({{"backlash", "X", ""}, {"servo-lag", "Y", ""}}, SurveyClass::kTwo);
  const nlohmann::json start = {{"effect", nullptr}, {"add", nullptr}};
  const auto step = [](const char* effect, const char* add) {
    return nlohmann::json{{"effect", effect}, {"add", add}};
  };
  const auto first = step("backlash", "backlash:axis=X,dof=X"),
             second = step("servo-lag", "servo-lag:dof=Y,axis=Y"),
             other = step("servo-lag", "servo-lag:axis=X");
  EXPECT_EQ(
      outcome(survey, "missing-effect", list({candidate("backlash", "X", "")}), list({start, second, first})),
      Outcome::kRight);
  EXPECT_EQ(outcome(survey, "missing-effect", list({candidate("backlash", "X", "")}), list({start, first})),
            Outcome::kHalf);
  EXPECT_EQ(
      outcome(survey, "missing-effect", list({candidate("backlash", "X", "")}), list({start, first, other})),
      Outcome::kWrong);
}

TEST(DiagnoseAnswer, CountsAnyNameAsWrongWhereNothingIsHidden) {
  for (const SurveyClass kind : {SurveyClass::kNoise, SurveyClass::kOutside}) {
    Case one;
    one.spec.kind = kind;
    one.judgement = judge(
        survey_hiding({}, kind),
        nlohmann::json{{"verdict", "missing-effect"}, {"candidates", list({candidate("custom", "X", "")})}}
            .dump());
    EXPECT_TRUE(is_wrong_name(one));
    EXPECT_FALSE(is_good(one));
  }
}

TEST(DiagnoseAnswer, RefusesWhatIsNotTheContract) {
  const HiddenSurvey survey = survey_hiding({{"backlash", "X", ""}});
  EXPECT_EQ(judge(survey, "").outcome, Outcome::kError);
  EXPECT_EQ(judge(survey, R"({"verdict":"missing-effect"})").outcome, Outcome::kError);
  EXPECT_EQ(outcome(survey, "missing-effect", nlohmann::json::array()), Outcome::kError);
  EXPECT_EQ(outcome(survey, "no-such-verdict", nlohmann::json::array()), Outcome::kError);
}

TEST(DiagnoseRates, GivesTheIntervalOfAShare) {
  // Wilson's interval of 0 of 1000 ends at z^2 / (n + z^2) = 0.38 %.
  EXPECT_EQ(share_text(0, 1000), "  0.0 % (0.0 .. 0.4)");
  EXPECT_EQ(share_text(0, 0), "-");
}

}  // namespace
}  // namespace vernier::bench
