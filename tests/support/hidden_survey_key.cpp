// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey_key.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/support/hidden_survey.h"
#include "tests/support/hidden_survey_forms.h"

namespace vernier::support {
namespace {

constexpr std::array<const char*, 5> kClassNames = {"single", "two", "outside", "noise", "confusable"};

nlohmann::json to_json(const Cause& cause) {
  const auto or_null = [](const std::string& s) { return s.empty() ? nlohmann::json() : nlohmann::json(s); };
  return {{"effect", cause.effect}, {"axis", or_null(cause.axis)}, {"input", or_null(cause.input)}};
}

/// Why a term counts as outside although it depends on one axis alone.
const char* why_outside(const std::string& effect) {
  return effect == "outside:chirp"
             ? "half-waves shorter than an eighth of the axis: no smooth curve (straightness, positioning "
               "error), though a table dense enough takes it away; no period either"
             : "";
}

}  // namespace

const char* class_name(SurveyClass kind) { return kClassNames[static_cast<std::size_t>(kind)]; }

SurveyClass class_named(const std::string& name) {
  for (std::size_t i = 0; i < kClassNames.size(); ++i)
    if (name == kClassNames[i]) return static_cast<SurveyClass>(i);
  throw std::invalid_argument("no survey class '" + name + "'");
}

std::vector<std::string> effects_of(Family family) {
  if (const auto own = effects_in_likeness(family); !own.empty()) return own;
  const Geometry g = geometry_of(family);
  std::vector<std::string> effects;
  for (const EffectScan& scan : effect_scans()) {
    const std::string effect = scan.effect;
    const bool rotary = !g.all_linear();
    if (demands_of(effect).probing && (rotary || g.axes.size() < 3)) continue;
    if (effect == "joint-compliance" && !rotary) continue;
    if (g.axes.size() < 3 &&
        (demands_of(effect).bare || effect == "angular-error" || effect == "thermal-bend"))
      continue;
    if (effect == "positioning-error") continue;  // no id of FORMATS: an alternative only
    if (effect == "offset" && !rotary) continue;
    if (effect == "gravity-sag" && g.bends.empty()) continue;
    if (effect == "thermal-scale" &&
        std::all_of(g.axes.begin(), g.axes.end(), [](const AxisPlace& a) { return a.rotary; }))
      continue;
    // A circle that is read too late is the same circle.
    if (family == Family::kBallBar && (effect == "time-sync" || effect == "time-base")) continue;
    if (g.axes.size() == 1 &&
        (effect == "lateral-play" || effect == "straightness" || effect == "gravity-sag" ||
         effect == "servo-mismatch" || effect == "centrifugal"))
      continue;
    effects.push_back(effect);
  }
  return effects;
}

std::string key_of(const HiddenSurvey& survey) {
  nlohmann::json list = nlohmann::json::array(), others = nlohmann::json::array();
  for (const HiddenEffect& e : survey.effects) {
    nlohmann::json item = to_json(e.cause), names = nlohmann::json::array();
    for (const Cause& cause : e.accept) names.push_back(to_json(cause));
    item.update({{"inputs", e.inputs},
                 {"branch", e.branch},
                 {"transform", e.transform},
                 {"dof", e.dof},
                 {"term", e.term},
                 {"accept", names},
                 {"ratio", e.ratio},
                 {"remaining", e.remaining},
                 {"statics", e.statics}});
    if (const std::string why = why_outside(e.cause.effect); !why.empty()) item["why_outside"] = why;
    list.push_back(item);
  }
  for (const Alternative& r : survey.alternatives) {
    nlohmann::json item = to_json(r.cause);
    item.update({{"term", r.term}, {"excess_chi_square", r.excess}});
    others.push_back(item);
  }
  return nlohmann::json{{"seed", survey.spec.seed},
                        {"family", family_name(survey.spec.family)},
                        {"class", class_name(survey.spec.kind)},
                        {"u_mm", survey.spec.u_mm},
                        {"observations", survey.observations},
                        {"parameters", survey.parameters},
                        {"effects", list},
                        {"rivals", others},
                        {"can_tell", survey.can_tell}}
             .dump(2) +
         "\n";
}

}  // namespace vernier::support
