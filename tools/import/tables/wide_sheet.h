// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Converts a sheet with a column for each run and approach direction ("Pos | 1+ | 1- | 2+ …", "Run 1 fwd",
/// "hin 1", "Messung 1 ↑") to a sheet with one row per reading and the columns run and sense. A reading is a
/// deviation if its heading or a title says this. Otherwise a reading is a position if its values spread as
/// the positions do, else a deviation. Returns the number of columns that were joined; 0 if the sheet is of
/// another kind and is not changed. Throws InputError: the same run and direction twice, a table that would
/// be too large.
std::size_t unfold_runs(sheet::Sheet& sheet, sheet::SheetTable& table);

}  // namespace vernier::importer
