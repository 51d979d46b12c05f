// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/fitted_effect.h"

#include "tools/effects/add.h"
#include "tools/fit/coverage/domain.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/model/rebind.h"

namespace vernier::effects {
namespace {

model::Static& static_of(model::Machine& machine, const CandidateUnknown& unknown) {
  return machine.statics[machine.find_static(unknown.name).value()];
}

void start_at(model::Machine& machine, const Candidate& effect, const std::vector<double>& coefficients) {
  auto value = coefficients.begin();
  if (coefficients.empty()) return;
  for (const CandidateUnknown& unknown : linear_unknowns(effect))
    static_of(machine, unknown).value = *value++;
}

/// Holds the unknowns that the fit moved out of the range of their search. Returns true if there
/// was such an unknown.
bool hold_runaways(model::Machine& machine, const std::vector<EffectToFit>& effects, FittedEffects& result) {
  bool any = false;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    if (!effects[i].is_driven_out) continue;
    std::size_t index = 0;
    for (const CandidateUnknown& unknown : scanned_unknowns(result.effects[i])) {
      if (!effects[i].is_driven_out(index++, static_of(result.fit.machine, unknown).value)) continue;
      static_of(machine, unknown).hidden = true;
      any = true;
    }
  }
  return any;
}

}  // namespace

MachineText machine_text(const std::string& text, const std::string& file) {
  return {text, with_base_row(model::parse_machine(text, file))};
}

MachineText fitted_text(const std::string& text, const fit::FitResult& fit) {
  return {model::update_machine_text(text, fit.machine, true), fit.machine};
}

Candidate put_in(MachineText& into, const Choice& choice) {
  Candidate effect = make_candidate(into.machine, choice);
  into = machine_text(add_to_machine_text(into.text, into.machine, effect), into.machine.file);
  return effect;
}

void hold_scanned(model::Machine& machine, const Candidate& effect, bool held) {
  for (const CandidateUnknown& unknown : scanned_unknowns(effect)) static_of(machine, unknown).hidden = held;
}

FittedEffects fit_with_effects(const MachineText& base, const model::Measurement& rows,
                               const std::vector<EffectToFit>& effects, const fit::FitOptions& options) {
  FittedEffects result;
  MachineText with = machine_text(base.text, base.machine.file);
  for (const EffectToFit& effect : effects) result.effects.push_back(put_in(with, effect.choice));
  model::Machine& machine = with.machine;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    start_at(machine, result.effects[i], effects[i].coefficients);
    if (effects[i].hold_scanned) hold_scanned(machine, result.effects[i], true);
  }
  result.rows = model::rebind(rows, base.machine, machine);
  result.fit = fit::fit(machine, result.rows, options);
  if (hold_runaways(machine, effects, result)) result.fit = fit::fit(machine, result.rows, options);
  result.text = model::update_machine_text(with.text, result.fit.machine, true);
  result.text = fit::close_domains(result.text, result.fit.machine, result.rows);
  return result;
}

}  // namespace vernier::effects
