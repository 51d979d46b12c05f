// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/effects/candidate.h"
#include "tools/model/machine.h"

namespace vernier::effects {

/// Adds a new static with the value 0 to a degree of freedom, so that its derivative can be computed. The
/// name of this static cannot occur in an expression of a machine file. add_probe returns the index of the
/// static in `machine.statics`.
std::size_t add_probe(model::Machine& machine, const DofPlace& place);

}  // namespace vernier::effects
