// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/compile/types.h"

namespace vernier::compile {

/// Selects fixed-point formats by interval analysis and writes the straight-line program. Each register has a
/// proved error bound. tick_us: the cycle time for lags and slew limits. Throws InputError if a format or the
/// size is not sufficient.
LoweredProgram lower(const model::Machine& machine, const Derivation& derivation, std::uint32_t tick_us);

/// Returns the shares of derivation.parts, computed from the registers of `tick` (the lowered program of the
/// same derivation).
LoweredShares lower_shares(const model::Machine& machine, const Derivation& derivation,
                           const LoweredProgram& tick);

}  // namespace vernier::compile
