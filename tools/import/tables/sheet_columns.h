// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/tables/sheet_wishes.h"

namespace vernier::importer {

/// Returns the meaning of each column: as assigned, else by its heading, and where that leaves it open by its
/// values. Throws InputError for a wish that fits no column.
std::vector<SheetColumn> columns_of_sheet(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                          const SheetWishes& wishes);

}  // namespace vernier::importer
