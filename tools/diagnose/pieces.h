// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// Returns items that are more likely parts of one function outside the catalogue than separate causes; empty
/// if there are no such items. A curve and a period of one axis may both be real. A third function of that
/// axis at the same degree of freedom (or at locations with the same effect on the readings) is evidence of
/// one function that the search did not find. If every row has only one reading, of one kind, functions of
/// any axis count. The limit is then a fourth function of position, a third beside a curve (three
/// coefficients or more), or a second curve. On a circle all such functions are functions of the angle, and
/// two curves span every function of the angle. Periods that are harmonics of each other count once. Two
/// periods that beat less than once over the measured range are one cyclic error that changes along the
/// range, not two causes.
std::vector<std::size_t> pieces_of_one_function(const Evidence& evidence, const Pool& pool,
                                                const std::vector<std::size_t>& items);

}  // namespace vernier::diagnose
