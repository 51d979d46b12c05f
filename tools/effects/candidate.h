// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/effects/types.h"
#include "tools/model/machine.h"

namespace vernier::effects {

/// The choice of a candidate with its scanned unknowns starting at these values. tool.
Choice choice_at(const Candidate& candidate, const std::vector<double>& scanned);

/// Adds a candidate's unknowns to the machine's statics, so that its terms can be evaluated: the coefficients
/// at 0, the others at `scanned` (0 where that is empty). Returns the index of each coefficient. tool.
std::vector<std::size_t> add_unknowns(model::Machine& machine, const Candidate& candidate,
                                      const std::vector<double>& scanned);

/// Fills the placeholders and names the unknowns so that they clash with nothing in the machine. `axes`: of
/// the same machine. Throws InputError where the choice leaves something open that the form needs. tool.
Candidate make_candidate(const model::Machine& machine, const AxisPlaces& axes, const Choice& choice);
Candidate make_candidate(const model::Machine& machine, const Choice& choice);

/// The effect of a term found by search: no named physics.
const Effect& custom_effect();

}  // namespace vernier::effects
