// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// Returns accepted effects that are likely parts of one function that the catalogue does not contain; empty
/// if there are no such effects. A curve and a cyclic error of one axis may both be real causes. A third
/// function of the same axis at the same degree of freedom is evidence of one function that the search did
/// not find. Locations with the same effect on the readings count as the same degree of freedom. If all
/// readings are of one kind, the functions of all axes count together towards the limit, and four functions
/// of position exceed the limit. Three functions exceed the limit if one is a curve (three
/// coefficients or more). Two curves also exceed the limit. On a circular path every function of position is
/// a function of the angle. Two curves can represent every function of the angle. Cyclic errors whose periods
/// are harmonics of each other count as one function. Two periods with a beat of less than one cycle over the
/// measured range are one cyclic error whose amplitude changes along the range.
std::vector<std::size_t> pieces_of_one_function(const Evidence& evidence, const Pool& pool,
                                                const std::vector<std::size_t>& items);

/// Returns two accepted effects at locations that move the readings alike: one effect depends on a
/// temperature or shifts runs, the other effect depends on the time but on no temperature. Both are probably
/// parts of one response to a source of heat that no thermometer of the survey records. Returns an empty list
/// if there are no two such effects.
std::vector<std::size_t> pieces_of_unrecorded_heat(const Evidence& evidence, const Pool& pool,
                                                   const std::vector<std::size_t>& items);

}  // namespace vernier::diagnose
