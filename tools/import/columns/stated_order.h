// SPDX-License-Identifier: GPL-3.0-or-later
// Approach directions and the order of readings by a text beside the table (words/stated_directions.h).
#pragma once
#include <cstddef>
#include <vector>

#include "tools/import/columns/sheet_wishes.h"
#include "tools/import/words/run_columns.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Gives the runs of a table with a column for each run the approach directions that a text states, with a
/// note. Runs whose headings state a direction, and a direction of all rows by the user, are not changed. A
/// text that does not state the direction of each run gets a note with the remedy.
void take_stated_directions(sheet::Sheet& sheet, const sheet::SheetTable& table, const SheetWishes& wishes,
                            std::vector<RunColumn>& runs);

/// Reverses the readings of the columns of the way back if a text states that they are in the order of their
/// measurement, with a note. A text that may state this gets a note with the remedy. `position`: the column
/// of the positions.
void turn_runs_back(sheet::Sheet& sheet, const sheet::SheetTable& table, const std::vector<RunColumn>& runs,
                    std::size_t position);

/// Adds a column of the approach directions that a text states to a table with one row for each reading: by
/// the numbers of its runs, or for all rows. Tables with directions are not changed. A text that cannot be
/// applied gets a note.
void add_stated_directions(sheet::Sheet& sheet, sheet::SheetTable& table, const SheetWishes& wishes);

/// Replaces the codes of a column of directions by + and - if a text states their meaning ("1 = rückwärts, 2
/// = vorwärts"), with a note.
void apply_direction_codes(sheet::Sheet& sheet, const sheet::SheetTable& table, const SheetWishes& wishes);

}  // namespace vernier::importer
