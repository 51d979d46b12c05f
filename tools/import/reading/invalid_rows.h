// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Removes the rows with a remark that says that the row is invalid ("ungültig", "discarded"). `sheet.notes`
/// names line and remark of each. A remark about one run or direction of a table with these side by side
/// ("Lauf 2 ungültig") empties the cells of this run alone. A remark about another reading ("Wiederholung, da
/// erste ungültig war") removes nothing and gets a note. Throws InputError if every row says so.
void leave_invalid_rows(sheet::Sheet& sheet, const sheet::SheetTable& table);

}  // namespace vernier::importer
