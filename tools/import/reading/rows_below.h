// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Throws InputError for a single last row behind an empty line whose position is not in the order of the
/// rows above it: numbers without words below a table ("13;11,4") are its count and its range.
void refuse_counts_below(const sheet::Sheet& sheet, const sheet::SheetTable& table);

/// Removes a column "Difference" beside the columns of runs, if its values are the differences between two of
/// these columns, with a note. `named`: the options of the user; a column that they name remains.
void leave_differences(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<std::string>& named);

}  // namespace vernier::importer
