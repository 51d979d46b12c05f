// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// True if a cell names a row that a spreadsheet computes from the rows above: "Mittelwert", "Std. dev.",
/// "Max".
bool says_computed_row(const std::string& cell);

/// Removes the rows of data that a spreadsheet computed (mean, spread, largest and smallest value), and
/// writes a note for each into the sheet. A label column may have the words min and max as the names of
/// states: there only a word that occurs once, behind all other words, names a computed row.
void leave_computed_rows(sheet::Sheet& sheet, const sheet::SheetTable& table);

/// Writes a note for each row of data with fewer cells than headings. Throws InputError if blanks separate
/// the columns, because the missing cell can then be any.
void note_short_rows(sheet::Sheet& sheet, const sheet::SheetTable& table);

}  // namespace vernier::importer
