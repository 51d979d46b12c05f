// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// Returns items that are more likely pieces of one function, which the catalogue does not
/// contain, than separate causes; empty if there are no such items. A curve and a period of one
/// axis may both be real. A third function of that axis at the same degree of freedom (or at
/// locations that move the readings alike) represents a function that was not found. If every row
/// has only one reading, of one kind, the limit is a fourth function of position, of any axis, a
/// third beside a curve (three coefficients or more), or a second curve. On a circle all of them
/// are functions of its angle, and two curves span every such function. Periods that are harmonics
/// of one another count once. Two periods that beat less than once over the measured range are one
/// wave that changes along it, not two causes. tool.
std::vector<std::size_t> pieces_of_one_function(const Evidence& evidence, const Pool& pool,
                                                const std::vector<std::size_t>& items);

}  // namespace vernier::diagnose
