// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/sheet/sheet.h"

namespace vernier::sheet {

/// Returns the index of the first row of each table in a sheet, including its titles. A new table begins at a
/// line of headings after rows of data, if there are also rows of data after this line. For a sheet with one
/// table, the result has one element.
std::vector<std::size_t> tables_of(const Sheet& sheet);

/// A table beside another one in the same rows: its columns, and the text above its headings.
struct TableBeside {
  std::size_t first = 0, end = 0;  // the column behind the last one
  std::string title;
};

/// Returns the tables of a sheet that are side by side: three columns or more each, with equal headings and
/// different titles ("X-Achse", "Y-Achse"), and an empty column between them. Empty: the sheet has one table.
std::vector<TableBeside> tables_side_by_side(const Sheet& sheet);

/// Keeps only the rows of one table. Pages with equal headings below a line with a page number ("Seite 2 von
/// 2") are one table and are joined, with a note, if `number` is nullopt. `number` counts the tables from 1.
/// Throws InputError if the sheet has no table with this number, or if it has several tables and `number` is
/// nullopt. The error message contains the first line of each table. If the rows are those of one table,
/// `number` counts the tables side by side.
void keep_table(Sheet& sheet, std::optional<std::size_t> number);

}  // namespace vernier::sheet
