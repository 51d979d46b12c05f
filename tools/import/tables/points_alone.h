// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/columns/column_guess.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Returns the sentence about a table whose numbers are only one point for each row (X, Y and Z, beside names
/// and numbers of the rows), with the command that reads the points of an instrument. Such a table is either
/// the points or the positions of the axes. Empty: another table, or a workbook.
std::string points_alone(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SheetColumn>& columns);

}  // namespace vernier::importer
