// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Converts runs side by side, each with its own column of positions ("Lauf 1 Pos | Lauf 1 Abw | Lauf 2 Pos |
/// Lauf 2 Abw", "1+ Pos | 1+ Abw | 1- Pos | 1- Abw", "Pos | Abw | Pos | Abw"), to one table with the rows of
/// run 2 below those of run 1 and a column `run`, with a note; approach directions get a column too, and a
/// mean of the runs is omitted. Returns false if the sheet has another form and is not changed. Throws
/// InputError if the runs have different units.
bool stack_runs(sheet::Sheet& sheet, sheet::SheetTable& table);

}  // namespace vernier::importer
