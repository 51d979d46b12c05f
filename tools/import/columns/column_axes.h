// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/columns/column_guess.h"
#include "tools/import/columns/sheet_wishes.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Assigns columns of positions whose headings state no axis, or only the position that the control shows.
/// The axis is that of the other headings, or of the titles. `columns`: their meaning by their headings
/// alone.
void settle_axes(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                 const Guess& guess);

}  // namespace vernier::importer
