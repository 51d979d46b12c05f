// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/compile/types.h"

namespace vernier::compile {

/// Selects fixed-point formats by interval arithmetic and writes the error equation as a program without
/// branches. Each register of the fixed-point program has a proved error bound. `tick_us`: the cycle time
/// for which lags and slew limits are computed. Throws InputError if no fixed-point format is sufficient or
/// if the program is too large.
LoweredProgram lower(const model::Machine& machine, const Derivation& derivation, std::uint32_t tick_us);

/// Returns the program for the shares of derivation.parts. The share program uses the registers of `tick`,
/// the lowered program of the same derivation.
LoweredShares lower_shares(const model::Machine& machine, const Derivation& derivation,
                           const LoweredProgram& tick);

}  // namespace vernier::compile
