// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/import/columns/sheet_wishes.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Returns the column whose values are the positions of the rows, in a table with one column for each run.
/// `others`: the columns that are not runs, at least one. Columns that count the rows, times, temperatures
/// and words are no positions. The first of these rules that finds a column applies: the user assigned an
/// axis to it; its heading names an axis, and the values change; its heading names a position, and the
/// values change; its heading names a position; its values are lengths or angles that change; it is the
/// first column.
std::size_t positions_of_runs(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                              const std::vector<std::size_t>& others, const SheetWishes& wishes);

}  // namespace vernier::importer
