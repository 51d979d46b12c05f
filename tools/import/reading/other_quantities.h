// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/columns/sheet_wishes.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Doubts the columns whose heading or title states another quantity than a deviation or a position:
/// - increments ("Incremental error", "Differenz zur Vorposition", a title "increment to previous target"):
///   each value is the change of the deviation from the position before;
/// - a length of motion ("Weg X", "Step X") with the same value in all rows, which is no position.
/// Diameters of a lathe ("X Durchmesser") are read as positions with a note. A column that the user states in
/// an option has no doubt.
void judge_other_quantities(sheet::Sheet& sheet, const sheet::SheetTable& table,
                            std::vector<SheetColumn>& columns);

/// Reads the slope of a tilt ("Nicken [um/m]") as an angle, with a note.
void read_slopes_as_angles(sheet::Sheet& sheet, sheet::SheetTable& table);

}  // namespace vernier::importer
