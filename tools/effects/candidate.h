// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/effects/types.h"
#include "tools/model/machine.h"

namespace vernier::effects {

/// Returns the choice of a candidate. Its scanned unknowns start at these values. tool.
Choice choice_at(const Candidate& candidate, const std::vector<double>& scanned);

/// Adds a candidate's unknowns to the machine's statics, so that its terms can be evaluated. The
/// coefficients are 0, the other unknowns are at `scanned` (0 if `scanned` is empty). Returns the
/// index of each coefficient. tool.
std::vector<std::size_t> add_unknowns(model::Machine& machine, const Candidate& candidate,
                                      const std::vector<double>& scanned);

/// Fills the placeholders. Gives the unknowns names that differ from all names of the machine.
/// `axes`: of the same machine. Throws InputError if the choice lacks something that the form
/// needs. tool.
Candidate make_candidate(const model::Machine& machine, const AxisPlaces& axes, const Choice& choice);
Candidate make_candidate(const model::Machine& machine, const Choice& choice);

/// Returns the effect of a term that a search found. It has no named physics.
const Effect& custom_effect();

}  // namespace vernier::effects
