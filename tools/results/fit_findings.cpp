// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/fit_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <optional>

#include "tools/model/fit_record.h"

namespace vernier::results {
namespace {

bool is_one_of(const model::FitRecord::Finding& finding, std::initializer_list<const char*> codes) {
  return std::any_of(codes.begin(), codes.end(), [&](const char* code) { return finding.code == code; });
}

/// Findings with which no later result holds.
bool forbids(const model::FitRecord::Finding& finding) {
  return is_one_of(finding, {"not-converged", "absurd", "no-gain", "far-from-nominal"});
}

/// Further findings with which a fit itself does not hold.
bool contradicts_fit(const model::FitRecord::Finding& finding) {
  return is_one_of(finding, {"something-missing", "disturbed", "not-varied", "not-distinguished",
                             "size-unknown", "far-from-nominal"});
}

/// True if the readings determine a parameter of the machine at least in part; set-ups do not count. nullopt:
/// no such parameter was free.
std::optional<bool> determines_the_machine(const fit::FitResult& result) {
  std::optional<bool> determined;
  for (std::size_t i = 0; i < result.estimates.size(); ++i)
    if (!model::is_set_up(result.parameters[i].kind))
      determined = determined.value_or(false) || result.estimates[i].from != fit::Origin::kPrior;
  return determined;
}

}  // namespace

nlohmann::ordered_json findings_json(const model::Machine& machine) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  if (machine.fitted)
    for (const model::FitRecord::Finding& one : machine.fitted->findings)
      list.push_back({{"code", one.code}, {"value", one.value}, {"text", one.text}});
  return list;
}

void add_findings(text::Assurance& word, const model::Machine& machine) {
  word.require("fitted", machine.fitted != nullptr,
               "The machine file contains a fit with the uncertainties of the parameters.");
  if (!machine.fitted) return;
  word.require("fit-converged", machine.fitted->converged, "The fit of the machine file converged.");
  for (const model::FitRecord::Finding& one : machine.fitted->findings) {
    if (forbids(one))
      word.require(one.code, false, one.text);
    else
      word.not_covered(one.text);
  }
}

text::Assurance assurance_of(const fit::FitResult& result) {
  text::Assurance word(text::AssuranceKind::kFit);
  word.require("converged", result.converged, "The fit converged.");
  word.require("sensible", result.absurd.empty(),
               result.absurd.empty() ? "The residuals are small enough for readings of this machine: units, "
                                       "signs and columns are plausible."
                                     : result.absurd);
  if (result.check_ratio)
    word.at_most("check-rows", *result.check_ratio, 1,
                 "Residual of the check rows (held-out rows) with the fitted machine, divided by their "
                 "residual with the nominal machine.");
  else {
    word.not_covered(
        "The fit was not tested on held-out rows, because there are fewer than twelve check readings.");
    word.require("redundancy", result.freedom >= 1,
                 fmt::format("The readings have {:.1f} degrees of freedom more than the fit used: below 1 no "
                             "residual can show an error of the model.",
                             result.freedom));
  }
  for (const model::FitRecord::Finding& one : result.machine.fitted->findings) {
    if (contradicts_fit(one))
      word.require(one.code, false, one.text);
    else if (!forbids(one))  // those are the rules above
      word.not_covered(one.text);
  }
  if (std::any_of(result.things.begin(), result.things.end(),
                  [](const fit::ThingEstimate& one) { return one.radius_mm || one.direction; }))
    word.not_covered(
        "An error of the probe that depends on the direction of the touch (lobes, pretravel) acts as an "
        "error of the machine: calibrate the probe first.");
  if (!result.things.empty())
    word.not_covered(
        "Touches do not show whether an effect depends on an axis that hardly moved between them: at other "
        "positions of the axes, compare the fitted machine with new readings.");
  if (const auto determined = determines_the_machine(result))
    word.require("determined", *determined, "The readings determine at least one parameter of the machine.");
  std::string open;
  for (const fit::ParameterEstimate& item : result.estimates)
    if (item.from == fit::Origin::kPrior) open += (open.empty() ? "" : ", ") + item.name;
  if (!open.empty())
    word.not_covered(
        fmt::format("These parameters are not measured or hardly measured; they are as uncertain as nominal "
                    "+- scale: {}.",
                    open));
  return word;
}

text::Assurance assurance_of(const safety::SafetySheet& sheet, const model::Machine& machine,
                             text::AssuranceKind kind) {
  text::Assurance word(kind);
  add_findings(word, machine);
  for (const safety::SafetyFinding& one : sheet.findings) {
    const std::string name = safety::rule_name(one.rule);
    const std::string culprit = one.culprit.empty() ? "" : fmt::format(" ({})", one.culprit);
    if (!one.value)
      word.not_covered(fmt::format("Rule {}: the machine file has no value for this rule.", name));
    else
      word.at_most(name, *one.value, one.limit,
                   fmt::format("Rule {}: {:.3g} {}, limit {:g}{}; {}.", name, *one.value, one.unit, one.limit,
                               culprit, one.reason));
  }
  for (const std::string& name : sheet.stale)
    word.not_covered(fmt::format("A parameter was added or set by hand since the fit: {}.", name));
  return word;
}

}  // namespace vernier::results
