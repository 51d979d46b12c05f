// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/effects/types.h"
#include "tools/model/machine.h"

namespace vernier::effects {

/// Returns the choice of a candidate. The scanned unknowns of the candidate start at the values `scanned`.
Choice choice_at(const Candidate& candidate, const std::vector<double>& scanned);

/// Adds a candidate's unknowns to the statics of the machine, so that its terms can be evaluated. The
/// coefficients are 0; the other unknowns have the values `scanned` (0 if `scanned` is empty). Returns the
/// index of each coefficient.
std::vector<std::size_t> add_unknowns(model::Machine& machine, const Candidate& candidate,
                                      const std::vector<double>& scanned);

/// Makes a candidate from a choice: fills the placeholders of the form. Gives the unknowns names that differ
/// from all names of the machine. `axes`: AxisPlaces of the same machine. Throws InputError if the choice
/// lacks an axis, input or location that the form needs.
Candidate make_candidate(const model::Machine& machine, const AxisPlaces& axes, const Choice& choice);
Candidate make_candidate(const model::Machine& machine, const Choice& choice);

/// Returns the axis that drives a choice, else the axis of the transform on which it acts.
std::optional<std::size_t> axis_of(const AxisPlaces& axes, const Choice& choice);

/// Returns the effect of a term that a search found. custom_effect() has no named physical cause.
const Effect& custom_effect();

}  // namespace vernier::effects
