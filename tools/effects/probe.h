// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/effects/candidate.h"
#include "tools/model/machine.h"

namespace vernier::effects {

/// Adds to a degree of freedom a new static of value 0. No expression can write its name. Returns
/// its index in `machine.statics`. tool.
std::size_t add_probe(model::Machine& machine, const DofPlace& place);

}  // namespace vernier::effects
