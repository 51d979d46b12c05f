// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include "tools/compile/types.h"

namespace vernier::compile {

/// `rounding`, `table`, `function`, `input`, `lag`.
const char* name_of(ErrorSource source);

/// The bounds of all outputs. tool.
std::vector<OutputBound> bounds_of(const model::Machine& machine, const Derivation& derivation,
                                   const LoweredProgram& program);
/// The same of the tool's direction; nothing where it is not corrected. tool.
std::optional<TiltBound> tilt_bound_of(const Derivation& derivation, const LoweredProgram& program);

}  // namespace vernier::compile
