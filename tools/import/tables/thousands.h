// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/columns/sheet_wishes.h"

namespace vernier::importer {

/// Decides the meaning of cells such as "1.000" in a table with a decimal point ("1,000" with a decimal
/// comma): 1 with three decimals, or 1000. The function writes a cell that means 1000 without the sign, and
/// writes a note into the sheet.
///   1. The other column of the axis (target or measured position) decides, row by row.
///   2. If the column has no other decimals, but whole numbers, the size of the whole numbers decides.
///   3. Otherwise a column whose cells all have decimals has decimals.
/// Throws InputError if the column has whole numbers, and their size does not decide.
void settle_thousands(sheet::Sheet& sheet, const sheet::SheetTable& table,
                      const std::vector<SheetColumn>& columns);

}  // namespace vernier::importer
