// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
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

/// The same for points that were joined with a list of positions: the machine moved in the order of the list,
/// also to positions without a point, and the rows of the points may have another order. `list`: the
/// positions of all rows of the list; `rows`: the row of the list for each row of the table. The runs of the
/// points divide the list if each position of the list has points of at most one run. An axis without a
/// column in the list gets no direction.
std::vector<std::string> add_directions_of_list(ImportTable& table, ImportTable list,
                                                const std::vector<std::size_t>& rows,
                                                const std::function<bool(const std::string&)>& is_axis);

}  // namespace vernier::importer
