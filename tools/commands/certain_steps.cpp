// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/certain_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "tools/effects/add_string.h"
#include "tools/effects/fitted_effect.h"
#include "tools/effects/types.h"
#include "tools/model/machine_reader.h"
#include "tools/model/rebind.h"

namespace vernier::commands {
namespace {

// Each open cause costs a diagnosis. Four is what the aliases of a period and two physical causes come to.
constexpr std::size_t kMostOpenCauses = 4;

/// A step that the data confirm and for which they leave no other period.
bool is_certain(const diagnose::Diagnosis& d, const diagnose::LadderStep& step) {
  const auto found = std::find_if(d.candidates.begin(), d.candidates.end(), [&](const auto& candidate) {
    return candidate.accepted && candidate.add == step.add;
  });
  return step.certain && step.confirmed.value_or(false) && found != d.candidates.end() &&
         found->aliases.empty();
}

bool is_open(const diagnose::Diagnosis& d, const std::string& add) {
  return d.causes.size() > 1 &&
         std::any_of(d.causes.begin(), d.causes.end(), [&](const auto& cause) { return cause.add == add; });
}

bool has_step(const diagnose::Diagnosis& d, const std::string& add) {
  return !is_open(d, add) && std::any_of(d.ladder.begin(), d.ladder.end(), [&](const auto& step) {
    return step.add == add && is_certain(d, step);
  });
}

effects::FittedEffects with_effect(const std::string& text, const model::Machine& machine,
                                   const model::Measurement& rows, const std::string& add,
                                   const std::vector<effects::Effect>& effects) {
  effects::EffectToFit effect;
  effect.choice = effects::parse_add_string(add, machine, effects);
  return effects::fit_with_effects(effects::machine_text(text, machine.name), rows, {effect});
}

}  // namespace

std::size_t certain_steps(const diagnose::Diagnosis& d) {
  if (d.verdict == diagnose::Verdict::kMissingEffect)
    return static_cast<std::size_t>(
        std::find_if(d.ladder.begin() + 1, d.ladder.end(), [](const auto& step) { return !step.certain; }) -
        d.ladder.begin() - 1);
  if (d.verdict != diagnose::Verdict::kAmbiguous || d.causes.size() > 1) return 0;
  std::size_t certain = 0;
  while (certain + 1 < d.ladder.size() && is_certain(d, d.ladder[certain + 1])) ++certain;
  return certain;
}

std::optional<diagnose::LadderStep> step_beside_open(const diagnose::Diagnosis& d, const std::string& text,
                                                     const model::Machine& machine,
                                                     const model::Measurement& rows,
                                                     const diagnose::DiagnoseOptions& options) {
  if (d.causes.size() < 2 || d.causes.size() > kMostOpenCauses || d.ladder.size() < 3 ||
      std::any_of(d.causes.begin(), d.causes.end(), [](const auto& cause) { return cause.add.empty(); }))
    return std::nullopt;
  std::vector<diagnose::LadderStep> steps;
  std::copy_if(
      d.ladder.begin() + 2, d.ladder.end(), std::back_inserter(steps),
      [&](const diagnose::LadderStep& step) { return is_certain(d, step) && !is_open(d, step.add); });
  for (const diagnose::Cause& cause : d.causes) {
    if (steps.empty()) return std::nullopt;
    if (cause.add == d.ladder[1].add) continue;  // the steps are those beside this cause
    const effects::FittedEffects with = with_effect(text, machine, rows, cause.add, options.effects);
    const model::Machine with_cause = model::parse_machine(with.text, machine.name);
    const diagnose::Diagnosis beside = diagnose::diagnose(
        with.text, with_cause, model::rebind(with.rows, with.fit.machine, with_cause), options);
    std::erase_if(steps, [&](const diagnose::LadderStep& step) { return !has_step(beside, step.add); });
  }
  for (diagnose::LadderStep& step : steps) {
    const effects::FittedEffects with = with_effect(text, machine, rows, step.add, options.effects);
    const std::optional<double>&before = d.ladder[0].check_rms_um, &after = with.fit.check.rms_um;
    if (!with.fit.converged || (before && after && *after > *before)) continue;
    step.text = with.text;
    step.rms_um = with.fit.after.rms_um, step.check_rms_um = with.fit.check.rms_um;
    step.rms_urad = with.fit.after.rms_urad, step.check_rms_urad = with.fit.check.rms_urad;
    return step;
  }
  return std::nullopt;
}

std::string choice_of_cause(const diagnose::Diagnosis& d, const std::string& file) {
  // The most likely cause by the explanation is that of the first step.
  auto named = std::find_if(d.causes.begin(), d.causes.end(), [&](const auto& cause) {
    return !cause.add.empty() && d.ladder.size() > 1 && cause.add == d.ladder[1].add;
  });
  if (named == d.causes.end())
    named =
        std::find_if(d.causes.begin(), d.causes.end(), [](const auto& cause) { return !cause.add.empty(); });
  if (named == d.causes.end()) return "";
  std::string add = named->add, periods;
  if (named->period && named->candidate) {
    std::size_t count = 0;
    for (const diagnose::Cause& cause : d.causes)
      if (cause.period && cause.axis == named->axis) {
        periods += fmt::format("{}{:.4g}", count == 0 ? "" : ", ", *cause.period);
        ++count;
      }
    if (count < 2) periods.clear();
    for (const effects::CandidateUnknown& unknown : effects::scanned_unknowns(*named->candidate)) {
      const std::string key = "start." + unknown.rule + "=";
      const std::size_t at = add.find(key);
      if (unknown.kind != effects::UnknownKind::kPeriod || at == std::string::npos || count < 2) continue;
      const std::size_t from = at + key.size();
      add.replace(from, std::min(add.find(',', from), add.size()) - from, "PERIOD");
      periods = fmt::format(
          " PERIOD is the pitch of the screw, the period of the scale or a turn of a gear{}: the readings "
          "do not distinguish the periods {}.",
          unknown.unit.empty() ? "" : ", in " + unknown.unit, periods);
    }
  }
  return fmt::format(
      "To correct this error too, decide for one cause: vernier add '{}' {} -o NEW.xml, then vernier fit.{}",
      add, file, periods);
}

}  // namespace vernier::commands
