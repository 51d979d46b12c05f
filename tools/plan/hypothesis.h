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

/// Returns the machine at its best fit, to which the alternatives are added.
effects::MachineText fit_model(const std::string& text, const model::Machine& machine,
                               const model::Measurement& measurement);

/// An effect that was added to a fitted machine and fitted to the same rows.
struct FittedHypothesis {
  effects::Candidate candidate;
  std::string add;
  model::Machine machine;  // with the effect, at its best fit; all unknowns of the effect are free
};

/// `name`: an effect id (the candidate of that effect which fits the rows best) or a complete `add` string.
/// The effects must outlive the result. Throws InputError: unknown effect, no candidate of the effect in
/// these rows.
FittedHypothesis fit_hypothesis(const effects::MachineText& model, const model::Measurement& measurement,
                                const std::string& name, const std::vector<effects::Effect>& effects);

/// Fits an alternative with given evidence of the model and the rows.
FittedHypothesis fit_hypothesis(const effects::MachineText& model, const diagnose::Evidence& evidence,
                                const model::Measurement& measurement, const std::string& name,
                                const std::vector<effects::Effect>& effects);

/// Decrease of chi^2 in units of the noise, minus the penalty of the BIC for the unknowns.
double value_of(const diagnose::Scored& scored, const diagnose::Evidence& evidence);

/// Splits the text of `--separate` at commas. A comma separates only if the text after it begins with the id
/// of an effect. Throws InputError if the number of parts is not two.
std::vector<std::string> split_hypotheses(const std::vector<std::string>& arguments,
                                          const std::vector<effects::Effect>& effects);

/// Variables of the alternatives besides positions and constants.
struct Drivers {
  std::set<model::SymbolKind> kinds;
  std::set<std::string> inputs;
};
Drivers drivers_of(const std::vector<const FittedHypothesis*>& hypotheses);

/// Returns the machine of the alternative without its effect: the coefficients of the effect are 0.
model::Machine without_effect(const FittedHypothesis& hypothesis);

}  // namespace vernier::plan
