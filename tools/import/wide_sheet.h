// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// A sheet with a column for each run and sense ("Pos | 1+ | 1- | 2+ …", "Run 1 fwd", "hin 1", "Messung 1 ↑")
/// is made a long one: a row for each reading, with the columns run and sense. What was read is a deviation
/// by its heading or a title, else a position where it spreads as the positions do, else a deviation. Result:
/// how many columns became one, 0 where the sheet is not of this kind and stays. Throws InputError: the same
/// run and sense twice, a table that would be too large. tool.
std::size_t unfold_runs(sheet::Sheet& sheet, sheet::SheetTable& table);

}  // namespace vernier::importer
