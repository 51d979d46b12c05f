// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/columns/sheet_wishes.h"

namespace vernier::importer {

/// Throws InputError if the quantities of a table are in rows and not in columns: the first column has the
/// headings ("Soll X [mm]", "Abweichung X [um]"), and the other cells of each row are the values.
void refuse_transposed(const sheet::Sheet& sheet, const sheet::SheetTable& table);

/// Removes lines of text below the table, with a note for each line. The text of such a line becomes a remark
/// of the sheet, because it can state the sign of the deviations.
void leave_words_below(sheet::Sheet& sheet, const sheet::SheetTable& table);

/// Writes a note into the sheet if the headings of target and actual of an axis may be exchanged: the values
/// of the actual position are round numbers (multiples of 0.1 mm or 0.1 deg), and those of the target are
/// not. Columns that the user assigned get no note.
void note_exchanged_headings(sheet::Sheet& sheet, const sheet::SheetTable& table,
                             const std::vector<SheetColumn>& columns);

}  // namespace vernier::importer
