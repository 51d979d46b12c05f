// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/propose/pool.h"
#include "tools/effects/add_string.h"
#include "tools/fit/fit.h"
#include "tools/maths/decompositions.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/text/error.h"

namespace vernier::plan {
namespace {

const effects::Effect* effect_named(const std::vector<effects::Effect>& effects, const std::string& id) {
  for (const effects::Effect& effect : effects)
    if (effect.id == id) return &effect;
  return id == effects::custom_effect().id ? &effects::custom_effect() : nullptr;
}

std::string id_of(const std::string& text) { return text.substr(0, text.find(':')); }

/// A time constant or decay length at the short end of the search range: the term has become a constant or a
/// spike and does not represent the effect of its name.
bool degenerate(const diagnose::Scored& scored, const diagnose::ScannedCandidate& item) {
  std::size_t next = 0;
  for (const effects::CandidateUnknown& unknown : effects::scanned_unknowns(item.candidate)) {
    const std::vector<double>& grid = item.grid[next];
    const bool decays =
        unknown.kind == effects::UnknownKind::kTime || unknown.kind == effects::UnknownKind::kTravel;
    if (decays && grid.size() > 1 && scored.scanned[next] < 0.5 * (grid[0] + grid[1])) return true;
    ++next;
  }
  return false;
}

/// The `add` string of the candidate of one effect that fits the rows best.
std::string best_of_effect(const diagnose::Evidence& evidence, const effects::Effect& effect) {
  const std::vector<effects::Effect> one = {effect};
  const std::vector<diagnose::ScannedCandidate> list = diagnose::enumerate_candidates(evidence, one);
  diagnose::Scanner scanner(evidence, list);
  const Eigen::MatrixXd none(evidence.residual().size(), 0);
  std::vector<diagnose::Scored> scored = scanner.scan(diagnose::AcceptedColumns(none), {});
  if (scored.empty())
    throw text::InputError(
        fmt::format("\"{}\": these rows do not show it at any location (give an add string)", effect.id));
  const auto value = [&](const diagnose::Scored& item) {
    constexpr double kPriceOfDegenerate = 6;  // as much evidence as a form that contains a simpler one needs
    return value_of(item, evidence) - (degenerate(item, list[item.candidate]) ? kPriceOfDegenerate : 0);
  };
  const auto worse = [&](const diagnose::Scored& a, const diagnose::Scored& b) {
    return value(a) < value(b);
  };
  std::sort(scored.rbegin(), scored.rend(), worse);
  constexpr std::size_t kRefined = 6;  // best of a grid that are refined
  scored.resize(std::min(scored.size(), kRefined));
  for (diagnose::Scored& item : scored) scanner.refine(item, none);
  const diagnose::Scored& best = *std::max_element(scored.begin(), scored.end(), worse);
  return effects::add_string(evidence.machine(),
                             effects::choice_at(list[best.candidate].candidate, best.scanned));
}

/// Returns the coefficients from the projected columns; empty if the model absorbs all of them.
std::vector<double> linear_estimate(const diagnose::Evidence& evidence, const effects::Candidate& candidate) {
  std::vector<double> scanned;
  for (const effects::CandidateUnknown& unknown : effects::scanned_unknowns(candidate))
    scanned.push_back(unknown.start);
  const Eigen::MatrixXd raw = evidence.columns(candidate, scanned);
  const Eigen::MatrixXd& q = evidence.absorbed();
  const Eigen::MatrixXd own = raw - q * (q.transpose() * raw);
  // Columns that the model absorbs leave only rounding here; it must not become a coefficient.
  constexpr double kLeastOwn = 1e-6;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(own);
  qr.setThreshold(kLeastOwn);
  if (own.norm() < kLeastOwn * raw.norm()) return {};
  const Eigen::VectorXd k = qr.solve(evidence.residual());
  return {k.begin(), k.end()};
}

}  // namespace

double value_of(const diagnose::Scored& scored, const diagnose::Evidence& evidence) {
  const double spread = evidence.chi_square() / std::max(1.0, evidence.freedom());
  const double variance = evidence.noise_known() ? 1 : std::max(spread, 1e-300);
  return scored.gain / variance -
         static_cast<double>(scored.unknowns) * std::log(static_cast<double>(evidence.rows().size()));
}

effects::MachineText fit_model(const std::string& text, const model::Machine& machine,
                               const model::Measurement& measurement) {
  return effects::fitted_text(text, fit::fit(effects::with_base_row(machine), measurement));
}

FittedHypothesis fit_hypothesis(const effects::MachineText& model, const model::Measurement& measurement,
                                const std::string& name, const std::vector<effects::Effect>& effects) {
  return fit_hypothesis(model, diagnose::Evidence(model.machine, measurement), measurement, name, effects);
}

FittedHypothesis fit_hypothesis(const effects::MachineText& model, const diagnose::Evidence& evidence,
                                const model::Measurement& measurement, const std::string& name,
                                const std::vector<effects::Effect>& effects) {
  const effects::Effect* effect = effect_named(effects, id_of(name));
  if (effect == nullptr)
    throw text::InputError(fmt::format("\"{}\": unknown effect (`vernier effects` lists them)", id_of(name)));
  FittedHypothesis hypothesis;
  hypothesis.add = name.find(':') == std::string::npos ? best_of_effect(evidence, *effect) : name;
  const model::Machine& base = model.machine;
  effects::EffectToFit one;
  one.choice = effects::parse_add_string(hypothesis.add, base, effects);
  one.coefficients = linear_estimate(evidence, effects::make_candidate(base, one.choice));
  // The result of the scan is fixed: data that cannot distinguish two effects do not determine a period
  // either.
  one.hold_scanned = true;
  effects::FittedEffects fitted = effects::fit_with_effects(model, measurement, {one});
  hypothesis.candidate = std::move(fitted.effects[0]);
  hypothesis.machine = std::move(fitted.fit.machine);
  effects::hold_scanned(hypothesis.machine, hypothesis.candidate, false);
  return hypothesis;
}

std::vector<std::string> split_hypotheses(const std::vector<std::string>& arguments,
                                          const std::vector<effects::Effect>& effects) {
  std::vector<std::string> parts;
  for (const std::string& argument : arguments) {
    std::size_t from = 0;
    for (std::size_t at = argument.find(','); at != std::string::npos; at = argument.find(',', at + 1)) {
      const auto end = argument.find_first_of(",:", at + 1);
      if (effect_named(effects, argument.substr(at + 1, end - at - 1)) == nullptr) continue;
      parts.push_back(argument.substr(from, at - from));
      from = at + 1;
    }
    parts.push_back(argument.substr(from));
  }
  if (parts.size() != 2)
    throw text::InputError(
        fmt::format("--separate requires two effects; the number of given effects is {}", parts.size()));
  return parts;
}

Drivers drivers_of(const std::vector<const FittedHypothesis*>& hypotheses) {
  Drivers drivers;
  for (const FittedHypothesis* hypothesis : hypotheses)
    for (const auto& [kind, index] : diagnose::drivers_of(hypothesis->machine, hypothesis->candidate)) {
      if (kind < 0) continue;  // a run by its label: new rows have a label of their own
      drivers.kinds.insert(static_cast<model::SymbolKind>(kind));
      if (static_cast<model::SymbolKind>(kind) == model::SymbolKind::kInput)
        drivers.inputs.insert(hypothesis->machine.inputs[index].name);
    }
  return drivers;
}

model::Machine without_effect(const FittedHypothesis& hypothesis) {
  model::Machine machine = hypothesis.machine;
  for (const effects::CandidateUnknown& unknown : effects::linear_unknowns(hypothesis.candidate))
    machine.statics[*machine.find_static(unknown.name)].value = 0;
  return machine;
}

}  // namespace vernier::plan
