// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/effects/types.h"
#include "tools/model/machine.h"

namespace vernier::effects {

/// Returns the choice (effect, location, inputs) of a candidate. The scanned unknowns of the candidate start
/// at the values `scanned`.
Choice choice_at(const Candidate& candidate, const std::vector<double>& scanned);

/// Adds the unknowns of a candidate to the statics of a machine, so that the terms of the candidate can be
/// evaluated. The coefficients have the value 0. The other unknowns have the values `scanned`, or 0 if
/// `scanned` is empty. The function returns the index of each coefficient in the statics.
std::vector<std::size_t> add_unknowns(model::Machine& machine, const Candidate& candidate,
                                      const std::vector<double>& scanned);

/// Makes a candidate from a choice: replaces the placeholders in the form of the effect. The names of the
/// candidate's unknowns are different from all names of the machine. `axes`: the AxisPlaces object of the
/// same machine. Throws InputError if the choice has no axis, input or location although the form needs it.
Candidate make_candidate(const model::Machine& machine, const AxisPlaces& axes, const Choice& choice);
Candidate make_candidate(const model::Machine& machine, const Choice& choice);

/// Returns the axis that drives the effect of a choice. If no axis drives the effect, returns the axis of the
/// transform on which the effect acts.
std::optional<std::size_t> axis_of(const AxisPlaces& axes, const Choice& choice);

/// Returns the effect for terms that a search found and that have no named physical cause.
const Effect& custom_effect();

}  // namespace vernier::effects
