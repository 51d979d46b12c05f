// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/tables/sheet_wishes.h"

namespace vernier::importer {

/// The rows of data as a measurement file's table. Throws InputError with file, line and word: a cell that is
/// not a number (with its probable meaning), a column without a unit, a name twice, no measured column, a
/// reading without a position.
ImportTable table_of_sheet(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                           const std::vector<SheetColumn>& columns, const SheetWishes& wishes);

}  // namespace vernier::importer
