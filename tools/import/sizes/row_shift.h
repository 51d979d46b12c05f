// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/sizes/sized_column.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Tests whether a column of readings is shifted by one row against the targets. Returns a doubt if the
/// measured positions agree with the targets of the row above or below, and not with those of their own row.
/// A column that the user stated in an option gets a note in `sheet` instead. `sheet` also gets a note if all
/// measured positions of a motion in equal steps differ from their targets by one step, and if only the first
/// reading of a column is empty.
std::vector<SizeDoubt> judge_row_shift(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                       const std::vector<SizedColumn>& columns);

}  // namespace vernier::importer
