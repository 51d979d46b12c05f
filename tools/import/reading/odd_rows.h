// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Removes lines about the state of the machine or the air between the rows of data ("Temp. Maschine;20,4"),
/// with a note for each: the cell of the position has a word for a temperature, a pressure, a humidity, a
/// time or a pause.
void leave_state_lines(sheet::Sheet& sheet, const sheet::SheetTable& table);

/// Notes remarks about a repetition ("Nachmessung") in rows whose position another row has too: both rows are
/// read.
void note_repeated_readings(sheet::Sheet& sheet, const sheet::SheetTable& table);

/// Notes the cells with a failed formula ("#DIV/0!"), which have no value.
void note_failed_formulas(sheet::Sheet& sheet, const sheet::SheetTable& table);

}  // namespace vernier::importer
