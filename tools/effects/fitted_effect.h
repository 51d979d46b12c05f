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

/// A machine together with its file's text: what effects are put into. The machine has a row for rigid
/// motions of the whole (with_base_row), the text only once a term stands there.
struct MachineText {
  std::string text;
  model::Machine machine;
};

/// Reads a machine that effects may be put into; `file` is for messages. Throws InputError. tool.
MachineText machine_text(const std::string& text, const std::string& file);

/// The machine at its best fit, and its text with the fitted values. tool.
MachineText fitted_text(const std::string& text, const fit::FitResult& fit);

/// Writes one more effect into both. Returns it with the names that its unknowns got. Throws InputError.
/// tool.
Candidate put_in(MachineText& into, const Choice& choice);

/// An effect to put in and fit, and where its unknowns begin.
struct EffectToFit {
  Choice choice;  // with the starts of the unknowns that are no coefficients
  /// Where the coefficients begin, in their order: a time constant has no derivative while its term is 0.
  /// Empty: all at 0.
  std::vector<double> coefficients;
  bool hold_scanned = false;  // periods, time constants and decay lengths stay at their start
  /// Has a fit driven the scanned unknown of this index out of where it was looked for? Then it is held at
  /// its start, and all is fitted again. None: it never has.
  std::function<bool(std::size_t, double)> is_driven_out;
};

struct FittedEffects {
  std::string text;                // the machine's file with the effects, fitted
  std::vector<Candidate> effects;  // with the names that their unknowns have there
  model::Measurement rows;         // bound to that machine: rows that lack an input are excluded
  fit::FitResult fit;
};

/// The one way to put effects into a machine and fit it: written into the text one after the other, the rows
/// bound to the inputs that came with them, everything that is free fitted. Of a term that was learned on
/// features the text says where it is valid. Throws InputError. tool.
FittedEffects fit_with_effects(const MachineText& base, const model::Measurement& rows,
                               const std::vector<EffectToFit>& effects, const fit::FitOptions& options = {});

/// Marks the scanned unknowns of an effect as held, or as free. tool.
void hold_scanned(model::Machine& machine, const Candidate& effect, bool held);

}  // namespace vernier::effects
