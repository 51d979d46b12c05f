// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/judgement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/text/numbers.h"

namespace vernier::evaluate {
namespace {

constexpr double kEqual = 1e-12;  // of the tolerance: what arithmetic in another unit leaves

}  // namespace

Conformity conformity(double value, double tolerance, double expanded_uncertainty) {
  const double limit = text::decisive(tolerance, "tolerance") + kEqual * std::abs(tolerance);
  const double expanded = text::decisive(expanded_uncertainty, "uncertainty");
  if (text::decisive(value, "value") + expanded <= limit) return Conformity::kMet;
  return value - expanded > limit ? Conformity::kNotMet : Conformity::kUndecided;
}

const char* conformity_text(Conformity conformity) {
  switch (conformity) {
    case Conformity::kMet:
      return "met";
    case Conformity::kNotMet:
      return "not met";
    case Conformity::kUndecided:
      return "not decided (within the uncertainty)";
  }
  return "";
}

JudgedText judged_text(const JudgedValue& one, int least) {
  constexpr int kMost = 15;  // digits behind the point: all that a double has
  const double value = one.value.value_or(0), expanded = one.expanded.value_or(0);
  const Conformity answer = conformity(value, one.tolerance, expanded);
  JudgedText words;
  for (int digits = least; digits <= kMost; ++digits) {
    const auto print = [&](double number) { return fmt::format("{:.{}f}", number, digits); };
    const auto read = [](const std::string& word) { return *text::parse_number(word); };
    words = {print(value), print(expanded), text::number_text(read(print(one.tolerance)))};
    if (!one.value || conformity(read(words.value), read(words.tolerance), read(words.uncertainty)) == answer)
      break;
  }
  if (!one.value) words.value = "–";
  if (!one.expanded) words.uncertainty = "–";
  return words;
}

text::Assurance assurance_of(const std::vector<JudgedValue>& all, const std::string& unit) {
  text::Assurance assurance(text::AssuranceKind::kEvaluate);
  if (all.empty()) assurance.not_covered("No tolerance is given, so no value was compared with a tolerance.");
  for (const JudgedValue& one : all) {
    const std::string rule = "tolerance-" + one.name;
    if (!one.value) {
      assurance.require(rule, false, "These readings do not have " + one.name + ".");
      continue;
    }
    const double expanded = one.expanded.value_or(0), reach = *one.value + expanded;
    const bool met = conformity(*one.value, one.tolerance, expanded) == Conformity::kMet;
    assurance.at_most(rule, met ? std::min(reach, one.tolerance) : reach, one.tolerance,
                      fmt::format("The value of {} plus its expanded uncertainty, {}.", one.name, unit));
    if (!one.expanded)
      assurance.not_covered(fmt::format(
          "No uncertainty is given, so only the value is compared with the tolerance: {}.", one.name));
  }
  return assurance;
}

}  // namespace vernier::evaluate
