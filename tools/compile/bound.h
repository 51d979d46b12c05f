// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include "tools/compile/types.h"

namespace vernier::compile {

/// Returns the name of an error source: `rounding`, `table`, `function`, `input`, `lag`.
const char* name_of(ErrorSource source);

/// Returns the proved error bounds of all outputs (axis corrections) of a compiled program.
std::vector<OutputBound> bounds_of(const model::Machine& machine, const Derivation& derivation,
                                   const LoweredProgram& program);
/// Returns the proved bound of the error of the tool's direction; nullopt if the direction is not corrected.
std::optional<TiltBound> tilt_bound_of(const Derivation& derivation, const LoweredProgram& program);

}  // namespace vernier::compile
