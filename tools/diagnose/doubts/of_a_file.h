// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// Returns the name of the file whose readings alone drift, if such a drift explains the readings as well as
/// the accepted effect `item` does; otherwise empty. The drift shifts all readings of one kind in this file
/// together, as a polynomial of the time up to the third degree (of the order of the rows, if all times are
/// equal). An effect of the machine is in the readings of all files, a drift of an instrument only in its
/// own. Effects without an input, and readings of one file, have no such drift: the noise model contains
/// drifts of all readings. The test compares the BIC as daily_drift_explains() does.
std::string file_whose_drift_explains(const Evidence& evidence, const Pool& pool, std::size_t item,
                                      const std::vector<std::size_t>& others, double distance);

}  // namespace vernier::diagnose
