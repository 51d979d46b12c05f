// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/text/assurance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace vernier::text {

double decisive(double value, std::string_view what) {
  if (!std::isfinite(value))
    throw std::logic_error(fmt::format("{} is not a finite number: no verdict", std::string(what)));
  return value;
}

const char* assurance_name(AssuranceKind kind) {
  constexpr const char* kNames[] = {"fit",     "diagnose",   "check",    "compile", "export", "upload",
                                    "rollout", "conformity", "evaluate", "solve",   "plan"};
  return kNames[static_cast<std::size_t>(kind)];
}

void Assurance::at_most(std::string rule, double value, double limit, std::string text) {
  const bool ok = decisive(value, rule) <= decisive(limit, rule);
  rules_.push_back({std::move(rule), value, limit, std::move(text), ok});
}

void Assurance::at_least(std::string rule, double value, double limit, std::string text) {
  const bool ok = decisive(value, rule) >= decisive(limit, rule);
  rules_.push_back({std::move(rule), value, limit, std::move(text), ok});
}

void Assurance::require(std::string rule, bool ok, std::string text) {
  rules_.push_back({std::move(rule), ok ? 0.0 : 1.0, 0, std::move(text), ok});
}

void Assurance::not_covered(std::string text) { uncovered_.push_back(std::move(text)); }

bool Assurance::holds() const {
  return !rules_.empty() &&
         std::all_of(rules_.begin(), rules_.end(), [](const AssuranceRule& one) { return one.ok; });
}

std::vector<AssuranceRule> Assurance::because() const {
  if (holds()) return rules_;
  std::vector<AssuranceRule> failed;
  for (const AssuranceRule& one : rules_)
    if (!one.ok) failed.push_back(one);
  return failed;
}

nlohmann::ordered_json Assurance::json() const {
  nlohmann::ordered_json json = {
      {"kind", assurance_name(kind_)}, {"holds", holds()}, {"because", nlohmann::ordered_json::array()}};
  for (const AssuranceRule& one : because())
    json["because"].push_back(
        {{"rule", one.rule}, {"value", one.value}, {"limit", one.limit}, {"text", one.text}});
  json["not_covered"] = uncovered_;
  return json;
}

}  // namespace vernier::text
