// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Empties a block of statistics beside the table ("Mittelwert | 4,6" in the row of a measurement), with a
/// note, so that its words are not about the rows of the measurement. A block is the columns between two
/// empty columns, or from its column of words to the right end. It has two or more words of statistics, and
/// no column of positions; without an empty column before it, also no readings. Columns to which an option
/// assigns a meaning (`named`) keep their values.
void leave_side_statistics(sheet::Sheet& sheet, sheet::SheetTable& table,
                           const std::vector<std::string>& named);

}  // namespace vernier::importer
