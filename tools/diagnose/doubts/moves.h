// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// Returns one sentence with the reason why an accepted effect may only be an error that changes at each
/// reversal of an axis (stick-slip: the axis rests elsewhere after each reversal); empty if there is no
/// reason for doubt. The test replaces the effect by an offset along the axis between two reversals. The
/// offsets are independent and normally distributed, with a variance that is estimated (restricted by nothing
/// else: marginal likelihood of a random effect, Searle 1992, 6.4). Such offsets explain an effect as well
/// only if the effect is nearly constant between two reversals. The test requires a given uncertainty u, and
/// readings with independent errors.
std::string doubt_of_moves(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                           std::size_t item);

}  // namespace vernier::diagnose
