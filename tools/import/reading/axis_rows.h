// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/import/columns/sheet_wishes.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Which rows have the axis in their own cell: an empty cell has the axis above it, or the table is not
/// converted. After runs side by side became rows, the row above may belong to another run.
enum class AxisCells { kAboveToo, kInEachRow };

/// Converts a table whose rows belong to different axes ("Achse | Soll | Ist", rows X, Y, Z) to a table with
/// own columns for each axis: "Soll X | Ist X | Soll Y | …". The constants of these axes in `wishes` become
/// the positions of the axes in the rows of the other axes, and are removed from `wishes`. Returns false if
/// the sheet has another form and is not changed. Throws InputError if several axes move and the position of
/// one of them in the other rows is not stated.
bool unfold_axes(sheet::Sheet& sheet, sheet::SheetTable& table, SheetWishes& wishes, AxisCells cells_of);

/// Throws InputError for a column that names several axes, if the headings name no axis: the rows of such a
/// table cannot all belong to one axis. `assigned`: the user states columns; then the sheet gets a note.
void refuse_unread_axes(sheet::Sheet& sheet, const sheet::SheetTable& table, const SheetWishes& wishes,
                        bool assigned);

}  // namespace vernier::importer
