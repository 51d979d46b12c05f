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

/// A machine together with the text of its file. Effects are added to both. The machine has a row
/// for rigid motions of the whole (with_base_row). The text has that row only after a term uses
/// it.
struct MachineText {
  std::string text;
  model::Machine machine;
};

/// Reads a machine to which effects may be added. `file` is for messages. Throws InputError. tool.
MachineText machine_text(const std::string& text, const std::string& file);

/// Returns the machine at its best fit, and its text with the fitted values. tool.
MachineText fitted_text(const std::string& text, const fit::FitResult& fit);

/// Adds one more effect to both. Returns the effect with the final names of its unknowns. Throws
/// InputError. tool.
Candidate put_in(MachineText& into, const Choice& choice);

/// An effect to add and fit, with the start values of its unknowns.
struct EffectToFit {
  Choice choice;  // with the start values of the unknowns that are not coefficients
  /// Start values of the coefficients, in their order. A time constant has no derivative while its
  /// term is 0. Empty: all start at 0.
  std::vector<double> coefficients;
  bool hold_scanned = false;  // periods, time constants and decay lengths stay at their start
  /// Has a fit moved the scanned unknown of this index out of the range of its search? Then the
  /// unknown is held at its start, and everything is fitted again. Empty function: the answer is
  /// never yes.
  std::function<bool(std::size_t, double)> is_driven_out;
};

struct FittedEffects {
  std::string text;                // the machine's file with the effects, fitted
  std::vector<Candidate> effects;  // with the final names of their unknowns
  model::Measurement rows;         // bound to that machine: rows that lack an input are excluded
  fit::FitResult fit;
};

/// The only function that adds effects to a machine and fits it. It writes the effects into the
/// text one after the other, binds the rows to the new inputs and fits everything that is free.
/// For a term that was learned on features, the text states the domain of validity. Throws
/// InputError. tool.
FittedEffects fit_with_effects(const MachineText& base, const model::Measurement& rows,
                               const std::vector<EffectToFit>& effects, const fit::FitOptions& options = {});

/// Marks the scanned unknowns of an effect as held or as free. tool.
void hold_scanned(model::Machine& machine, const Candidate& effect, bool held);

}  // namespace vernier::effects
