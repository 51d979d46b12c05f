// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Splits the cells of the positions into the position and a column of approach directions if each of them
/// ends with a sign: "50+", "50-". A table with another column of directions, and cells of one sign alone,
/// are not changed. The sheet gets a note.
void split_signed_positions(sheet::Sheet& sheet, sheet::SheetTable& table);

}  // namespace vernier::importer
