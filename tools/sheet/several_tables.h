// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/sheet/sheet.h"

namespace vernier::sheet {

/// Index of the first row of each table of a sheet, its titles included. A new table begins at a line of
/// headings that follows rows of data, if there are rows of data after this line. One entry for a sheet of
/// one table.
std::vector<std::size_t> tables_of(const Sheet& sheet);

/// Keeps the rows of one table, from 1. Throws InputError if the sheet has no table of this number, or if it
/// has several tables and `number` is nullopt. The error states the first line of each table.
void keep_table(Sheet& sheet, std::optional<std::size_t> number);

}  // namespace vernier::sheet
