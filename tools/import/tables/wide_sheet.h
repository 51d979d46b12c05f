// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

#include "tools/import/columns/sheet_wishes.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Converts a sheet with one column for each run and approach direction to a sheet with one row per reading
/// and the columns run and sense. Examples of headings are "Pos | 1+ | 1- | 2+ …", "Run 1 fwd", "hin 1",
/// "Messung 1 ↑". A reading is a deviation if its heading or a title states this. If neither heading nor
/// title states the meaning, a reading is a position if its values vary as much as the positions do;
/// otherwise it is a deviation. `wishes`: the assignments that the user stated, which may name the column of
/// the positions. Returns the number of columns that were joined; 0 if the sheet has another
/// form and is not changed. Throws InputError if the same run and direction occurs twice, or if the table
/// would be too large.
std::size_t unfold_runs(sheet::Sheet& sheet, sheet::SheetTable& table, const SheetWishes& wishes);

}  // namespace vernier::importer
