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

/// A machine and the text of its machine file. Effects are added to both. The machine has a transform for
/// rigid motions of the whole machine (with_base_row). The text of the machine file contains the transform
/// for rigid motions only after a term uses the transform.
struct MachineText {
  std::string text;
  model::Machine machine;
};

/// Reads a machine file to which effects may be added. `file`: name of the file in messages. Throws
/// InputError if the text is not a valid machine file.
MachineText machine_text(const std::string& text, const std::string& file);

/// Returns the machine at its best fit and the text of the machine file with the fitted values.
MachineText fitted_text(const std::string& text, const fit::FitResult& fit);

/// Adds one effect to the machine and to the text. put_in returns the effect with the final names of its
/// unknowns. Throws InputError if the effect cannot be added.
Candidate put_in(MachineText& into, const Choice& choice);

/// An effect that is added and fitted, with the start values of its unknowns.
struct EffectToFit {
  Choice choice;  // includes the start values of the unknowns that are not coefficients
  /// Start values of the coefficients, in their order. If the vector is empty, all coefficients start at 0. A
  /// start value different from 0 is useful for a time constant, because it has no derivative while its term
  /// is 0.
  std::vector<double> coefficients;
  bool hold_scanned = false;  // true: periods, time constants and decay lengths keep their start values
  /// Returns true if a fit moved the scanned unknown with this index out of its search range. An unknown out
  /// of its search range is fixed at its start value, and all other parameters are fitted again. If the
  /// function is empty, an unknown is never out of its search range.
  std::function<bool(std::size_t, double)> is_driven_out;
};

struct FittedEffects {
  std::string text;                // text of the machine file with the fitted effects
  std::vector<Candidate> effects;  // effects with the final names of their unknowns
  model::Measurement rows;         // rows for this machine; rows without a required input are excluded
  fit::FitResult fit;
};

/// Adds effects to a machine and fits them; no other function does this. fit_with_effects writes the effects
/// into the text one after another, reads the new inputs in the rows, and fits all free parameters. For a
/// term that was learned on features, the text also contains its domain of validity. Throws InputError if an
/// effect cannot be added or the fit is not possible.
FittedEffects fit_with_effects(const MachineText& base, const model::Measurement& rows,
                               const std::vector<EffectToFit>& effects, const fit::FitOptions& options = {});

/// Marks the scanned unknowns (periods, time constants, decay lengths) of an effect as fixed or as free.
void hold_scanned(model::Machine& machine, const Candidate& effect, bool held);

}  // namespace vernier::effects
