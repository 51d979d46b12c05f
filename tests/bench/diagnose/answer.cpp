// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/diagnose/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace vernier::bench {
namespace {

using nlohmann::json;
using support::Cause;
using support::HiddenEffect;
using support::HiddenSurvey;
using support::SurveyClass;

std::string text_of(const json& object, const char* key) {
  const json& value = object.at(key);
  return value.is_null() ? std::string() : value.get<std::string>();
}

bool has_input(const json& candidate, const std::string& input) {
  if (input.empty() || text_of(candidate, "input") == input) return true;
  return candidate.contains("inputs") && std::any_of(candidate["inputs"].begin(), candidate["inputs"].end(),
                                                     [&](const json& name) { return name == input; });
}

bool is_one_of(const json& candidate, const std::vector<HiddenEffect>& effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [&](const HiddenEffect& e) { return names(e, candidate); });
}

std::string brief(const json& answer) {
  std::string text = answer.at("verdict").get<std::string>();
  for (std::size_t i = 0; i < std::min<std::size_t>(2, answer.at("candidates").size()); ++i) {
    const json& c = answer["candidates"][i];
    text += fmt::format(" | {} axis={} input={} {}", text_of(c, "effect"), text_of(c, "axis"),
                        text_of(c, "input"), text_of(c, "term"));
  }
  return text;
}

/// The first candidates that name the first one as what they are confounded with.
std::vector<json> hypotheses_of_first(const json& candidates) {
  std::vector<json> group;
  if (candidates.empty()) return group;
  group.push_back(candidates[0]);
  const std::string first = text_of(candidates[0], "effect");
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const json& with = candidates[i].at("confounded_with");
    if (std::find(with.begin(), with.end(), first) == with.end()) break;
    group.push_back(candidates[i]);
  }
  return group;
}

/// Two effects: the steps accepted on the ladder, matched by their effect (the ladder has no axis of its own,
/// but its `add` does).
Outcome judge_two(const HiddenSurvey& survey, const json& answer) {
  std::vector<char> found(survey.effects.size(), 0);
  bool wrong = false;
  for (const json& step : answer.at("ladder")) {
    if (step.at("effect").is_null()) continue;
    json candidate = {{"effect", step["effect"]}, {"axis", nullptr}, {"input", nullptr}};
    const std::string add = step.at("add").get<std::string>();
    for (const char* key : {"axis", "input"}) {
      const std::size_t at = add.find(std::string(key) + "=");
      if (at == std::string::npos || (add[at - 1] != ':' && add[at - 1] != ',')) continue;
      const std::size_t from = add.find('=', at) + 1;
      candidate[key] = add.substr(from, add.find_first_of(",:", from) - from);
    }
    bool known = false;
    for (std::size_t e = 0; e < survey.effects.size(); ++e)
      if (names(survey.effects[e], candidate)) {
        known = true;
        found[e] = 1;
      }
    wrong = wrong || !known;
  }
  if (wrong) return Outcome::kWrong;
  const auto count = std::count(found.begin(), found.end(), 1);
  if (count == static_cast<std::ptrdiff_t>(found.size())) return Outcome::kRight;
  return count > 0 ? Outcome::kHalf : Outcome::kUnexplained;
}

Outcome of_verdict(const std::string& verdict) {
  if (verdict == "unexplained") return Outcome::kUnexplained;
  if (verdict == "instrument") return Outcome::kInstrument;
  if (verdict == "consistent") return Outcome::kConsistent;
  return Outcome::kError;
}

/// Did the search write down the hidden effect's axis and inputs, under no name?
bool is_custom_of(const HiddenSurvey& survey, const json& candidate) {
  if (survey.spec.kind != SurveyClass::kSingle || text_of(candidate, "effect") != "custom") return false;
  const HiddenEffect& hidden = survey.effects.at(0);
  return text_of(candidate, "axis") == hidden.cause.axis &&
         std::all_of(hidden.inputs.begin(), hidden.inputs.end(),
                     [&](const std::string& input) { return has_input(candidate, input); });
}

Outcome judge_one(const HiddenSurvey& survey, const json& answer) {
  const std::string verdict = answer.at("verdict");
  const json& candidates = answer.at("candidates");
  const bool first_right = !candidates.empty() && is_one_of(candidates[0], survey.effects);
  if (verdict == "missing-effect" && !first_right && is_custom_of(survey, candidates.at(0)))
    return Outcome::kCustom;
  if (verdict == "missing-effect") return first_right ? Outcome::kRight : Outcome::kWrong;
  if (verdict == "ambiguous") {
    const std::vector<json> group = hypotheses_of_first(candidates);
    const bool among =
        std::any_of(group.begin(), group.end(), [&](const json& c) { return is_one_of(c, survey.effects); });
    return among ? Outcome::kAmbiguous : Outcome::kAmbiguousMiss;
  }
  // A clock that is off is the instrument's: naming it under that verdict is right too.
  if (verdict == "instrument" && !survey.effects.empty()) {
    const std::string& hidden = survey.effects[0].cause.effect;
    // What shifts the one thing that is read, all at once, may be either.
    if (hidden == "base-drift" && survey.spec.family == support::Family::kBed) return Outcome::kRight;
    if (hidden == "time-base" || (hidden == "time-sync" && first_right)) return Outcome::kRight;
  }
  return of_verdict(verdict);
}

Judgement judge_json(const HiddenSurvey& survey, const json& answer) {
  Judgement result;
  result.said = brief(answer);
  const std::string verdict = answer.at("verdict");
  const json& candidates = answer.at("candidates");
  if (verdict == "missing-effect") {
    result.add = candidates.at(0).at("add");
    result.custom = candidates[0]["effect"] == "custom";
  }
  if (survey.spec.kind == SurveyClass::kTwo)
    result.outcome = judge_two(survey, answer);
  else
    result.outcome = judge_one(survey, answer);
  if (survey.spec.kind == SurveyClass::kNoise && verdict == "consistent") result.outcome = Outcome::kRight;
  return result;
}

}  // namespace

const char* outcome_name(Outcome outcome) {
  static constexpr std::array<const char*, kOutcomes> kNames = {
      "right",      "wrong",      "ambiguous", "ambig-miss", "unexplained",
      "instrument", "consistent", "custom",    "one-of-two", "error"};
  return kNames[static_cast<std::size_t>(outcome)];
}

bool names(const HiddenEffect& hidden, const json& candidate) {
  return std::any_of(hidden.accept.begin(), hidden.accept.end(), [&](const Cause& cause) {
    return text_of(candidate, "effect") == cause.effect &&
           (cause.axis.empty() || text_of(candidate, "axis") == cause.axis) &&
           has_input(candidate, cause.input);
  });
}

Judgement judge(const HiddenSurvey& survey, const std::string& text) {
  try {
    return judge_json(survey, json::parse(text));
  } catch (const json::exception& wrong) {
    return {Outcome::kError, std::string("JSON: ") + wrong.what(), "", false};
  }
}

}  // namespace vernier::bench
