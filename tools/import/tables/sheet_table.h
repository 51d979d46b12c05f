// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/columns/sheet_wishes.h"

namespace vernier::importer {

/// Converts the rows of data of a sheet to the table of a measurement file. Throws InputError with file, line
/// and word for: a cell that is not a number (with its probable meaning), a column without a unit, a name
/// that occurs twice, a table without a measured column, a reading without a position.
ImportTable table_of_sheet(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                           const std::vector<SheetColumn>& columns, const SheetWishes& wishes);

}  // namespace vernier::importer
