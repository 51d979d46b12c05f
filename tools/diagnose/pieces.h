// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/evidence.h"
#include "tools/diagnose/pool.h"

namespace vernier::diagnose {

/// Items that are more likely the pieces of one function that the catalogue does not hold than as many
/// causes; empty where there are no such. A curve and a period of one axis may well stand beside each other;
/// a third function of that axis at the same degree of freedom (or at places that move the readings alike)
/// takes the place of what was not found. Where every row has but one reading, of one kind, a fourth function
/// of position does, of whatever axis, a third beside a curve (three coefficients or more), or a second
/// curve: on a circle all of them are functions of its angle, and two curves span every such function.
/// Periods that are harmonics of one another count once; two periods that beat less than once over the range
/// that was read are one wave that changes along it, no two causes. tool.
std::vector<std::size_t> pieces_of_one_function(const Evidence& evidence, const Pool& pool,
                                                const std::vector<std::size_t>& items);

}  // namespace vernier::diagnose
