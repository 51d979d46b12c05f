// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/effects/candidate.h"
#include "tools/fit/fit.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::effects {

/// A machine and the text of its file; effects are added to both. The machine has a row for rigid motions of
/// the whole machine (with_base_row). The text has this row only after a term uses it.
struct MachineText {
  std::string text;
  model::Machine machine;
};

/// Reads a machine to which effects may be added. `file` is for messages. Throws InputError.
MachineText machine_text(const std::string& text, const std::string& file);

/// Returns the machine at its best fit and the text of the machine file with the fitted values.
MachineText fitted_text(const std::string& text, const fit::FitResult& fit);

/// Adds one more effect to the machine and to the text. put_in returns the effect with the final names of its
/// unknowns. Throws InputError.
Candidate put_in(MachineText& into, const Choice& choice);

/// An effect to add and fit, with the start values of its unknowns.
struct EffectToFit {
  Choice choice;  // with the start values of the unknowns that are not coefficients
  /// Start values of the coefficients, in the order of the coefficients; empty: all coefficients start at 0.
  /// A time constant has no derivative while its term is 0.
  std::vector<double> coefficients;
  bool hold_scanned = false;  // periods, time constants and decay lengths stay at their start
  /// True if a fit moved the scanned unknown of this index out of the range of its search. Such an unknown is
  /// fixed at its start value, and all other parameters are fitted again. An empty function: no unknown is
  /// ever out of its range.
  std::function<bool(std::size_t, double)> is_driven_out;
};

struct FittedEffects {
  std::string text;                // the machine's file with the effects, fitted
  std::vector<Candidate> effects;  // with the final names of their unknowns
  model::Measurement rows;         // bound to that machine: rows that lack an input are excluded
  fit::FitResult fit;
};

/// Adds effects to a machine and fits it; no other function does this. fit_with_effects writes the effects
/// into the text one after another, binds the rows to the new inputs and fits all free parameters. For a term
/// that was learned on features, the text also states the domain of validity. Throws InputError.
FittedEffects fit_with_effects(const MachineText& base, const model::Measurement& rows,
                               const std::vector<EffectToFit>& effects, const fit::FitOptions& options = {});

/// Marks the scanned unknowns of an effect as fixed or as free.
void hold_scanned(model::Machine& machine, const Candidate& effect, bool held);

}  // namespace vernier::effects
