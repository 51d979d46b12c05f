// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/sizes/sized_column.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Judges measured points (x, y, z) beside the positions X, Y, Z, in the frame of an instrument at any place.
/// A doubt: points that fit the positions only if they are shifted by one row, or only as a mirror image (two
/// coordinates are exchanged, or one has the wrong sign). Points that fit in no such way are not judged: the
/// machine may also rotate. Columns that the user assigned get a note in place of the doubt.
std::vector<SizeDoubt> judge_points(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                    const std::vector<SizedColumn>& columns);

}  // namespace vernier::importer
