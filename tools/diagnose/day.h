// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// True if an instrument that drifts with the time of day explains the readings as well as the accepted item
/// `item` does: readings of one kind shift together, as a sine with a period of 24 h. The temperature of a
/// hall has this period too. Only an effect that a recorded input drives can be confused in this way: items
/// without an input, and surveys without times, return false. Compared is the BIC, beside the other accepted
/// items `others`: the instrument's may be larger by less than `distance`.
bool daily_drift_explains(const Evidence& evidence, const Pool& pool, std::size_t item,
                          const std::vector<std::size_t>& others, double distance);

}  // namespace vernier::diagnose
