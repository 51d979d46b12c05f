// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/import/columns/column_map.h"

namespace vernier::importer {

/// Adds the approach direction (dirX) of each axis of the table that has none, by the order of the rows
/// (directions_of_last_motion). Rows of one run and set-up are a sequence of motions. Returns the names of
/// the columns that were added. Throws InputError if no axis of the table moves.
std::vector<std::string> add_directions_from_order(ImportTable& table,
                                                   const std::function<bool(const std::string&)>& is_axis);

}  // namespace vernier::importer
