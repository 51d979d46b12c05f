// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/propose/evidence.h"
#include "tools/diagnose/propose/pool.h"

namespace vernier::diagnose {

/// Returns one sentence with the reason why an accepted effect cannot follow the quantity that its name
/// states; empty if there is no reason for doubt. The test keeps the location and the dependence on the
/// positions, and replaces only the quantity: an input, the time, the number of rows or the run by a free
/// course over the rows, and the approach direction by the previous move. An effect without such a quantity
/// must keep its size over the rows. If a replacement explains much that the effect does not, the quantity is
/// one that no column records. The test requires a given uncertainty u.
std::string doubt_of_course(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                            std::size_t item);

/// Returns the first reason why an accepted effect cannot be what its name states: its shape (shape.h), the
/// quantity on which it depends, or the moves of the axes (moves.h); empty if there is no reason for doubt.
std::string doubt_of(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                     std::size_t item);

}  // namespace vernier::diagnose
