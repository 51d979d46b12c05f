// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/sheet/sheet.h"

namespace vernier::sheet {

/// Returns the index of the first row of each table in a sheet, including its titles. A new table begins at a
/// line of headings after rows of data, if there are also rows of data after this line. For a sheet with one
/// table, the result has one element.
std::vector<std::size_t> tables_of(const Sheet& sheet);

/// Keeps only the rows of one table. Pages with equal headings below a line with a page number ("Seite 2 von
/// 2") are one table and are joined, with a note, if `number` is nullopt. `number` counts the tables from 1.
/// Throws InputError if the sheet has no table with this number, or if it has several tables and `number` is
/// nullopt. The error message contains the first line of each table.
void keep_table(Sheet& sheet, std::optional<std::size_t> number);

}  // namespace vernier::sheet
