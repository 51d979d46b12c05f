// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Finds runs whose headings state the two approach directions by letters that mean a direction only as a
/// pair: "V1 | R1 | V2 | R2" (vor, rück), "1H | 1Z", "F1 | B1". Both letters have the same numbers of runs
/// (two or more) and the same unit. The names of these headings then have a word for the direction, and the
/// sheet has a note about it.
void say_directions_of_pairs(sheet::Sheet& sheet, sheet::SheetTable& table);

/// Returns a sentence that states how to name the columns of a table whose headings have two words, each with
/// the same numbers ("oda 1 | vissza 1 | oda 2 | vissza 2"): probably runs in an unknown language. Empty for
/// other tables.
std::string remedy_for_unknown_runs(const sheet::SheetTable& table);

}  // namespace vernier::importer
