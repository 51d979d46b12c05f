// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// True if a cell is the label of a row that a spreadsheet computes from the rows above: "Mittelwert" (mean),
/// "Std. dev.", "Max".
bool says_computed_row(const std::string& cell);

/// Removes the rows that a spreadsheet computed (mean, standard deviation, largest and smallest value), and
/// writes a note for each of these rows into the sheet. The words min and max in a label column may be names
/// of states. The word min or max is the label of a computed row only if it occurs once, after all other
/// words. A row with a position is a measurement with a remark, and gets another note, unless its numbers are
/// statistics of the rows above it. Throws InputError if the word is in a column that has a value in most
/// rows.
void leave_computed_rows(sheet::Sheet& sheet, const sheet::SheetTable& table);

/// Writes a note for each row of data that has fewer cells than there are headings. If blanks separate the
/// columns, throws InputError for a row with fewer cells, because any of its cells can be missing.
void note_short_rows(sheet::Sheet& sheet, const sheet::SheetTable& table);

}  // namespace vernier::importer
