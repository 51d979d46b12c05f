// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// True if a daily drift of the instrument explains the readings as well as the accepted effect `item` does.
/// The daily drift shifts all readings of one kind together, as a sine with a period of 24 h. The temperature
/// of a workshop also has a period of 24 h. The daily drift can be confused only with an effect that a
/// recorded input drives. Effects without an input, and surveys without times, return false. The test
/// compares the BIC of the effect and of the daily drift, each in a model with the other accepted effects
/// `others`. The BIC of the drift may be larger by less than `distance`.
bool daily_drift_explains(const Evidence& evidence, const Pool& pool, std::size_t item,
                          const std::vector<std::size_t>& others, double distance);

}  // namespace vernier::diagnose
