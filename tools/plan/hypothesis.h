// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <set>
#include <string>
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/scan.h"
#include "tools/effects/candidate.h"
#include "tools/effects/fitted_effect.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::plan {

/// Returns the machine file at its best fit. Alternative effects are added to this machine.
effects::MachineText fit_model(const std::string& text, const model::Machine& machine,
                               const model::Measurement& measurement);

/// An effect that was added to a fitted machine and fitted to the same rows.
struct FittedHypothesis {
  effects::Candidate candidate;
  std::string add;
  model::Machine machine;  // the fitted machine with this effect; all unknowns of the effect are free
};

/// `name`: the id of an effect (its candidate that fits the rows best is used), or a complete `add` string.
/// The object `effects` must exist longer than the result. Throws InputError if the effect is unknown or has
/// no candidate in these rows.
FittedHypothesis fit_hypothesis(const effects::MachineText& model, const model::Measurement& measurement,
                                const std::string& name, const std::vector<effects::Effect>& effects);

/// Fits an alternative effect. This overload uses the evidence of model and rows that the caller has already
/// computed.
FittedHypothesis fit_hypothesis(const effects::MachineText& model, const diagnose::Evidence& evidence,
                                const model::Measurement& measurement, const std::string& name,
                                const std::vector<effects::Effect>& effects);

/// Returns the value of a scored candidate: its decrease of chi^2 in units of the noise, minus the BIC
/// penalty of its unknowns.
double value_of(const diagnose::Scored& scored, const diagnose::Evidence& evidence);

/// Splits the argument of `--separate` at commas into the two effects. A comma is a separator only if the
/// text after the comma begins with the id of an effect. Throws InputError if there are not exactly two
/// parts.
std::vector<std::string> split_hypotheses(const std::vector<std::string>& arguments,
                                          const std::vector<effects::Effect>& effects);

/// Variables on which the alternative effects depend, besides positions and constants.
struct Drivers {
  std::set<model::SymbolKind> kinds;
  std::set<std::string> inputs;
};
Drivers drivers_of(const std::vector<const FittedHypothesis*>& hypotheses);

/// Returns the machine of an alternative without its effect: the coefficients of the effect are set to 0.
model::Machine without_effect(const FittedHypothesis& hypothesis);

}  // namespace vernier::plan
