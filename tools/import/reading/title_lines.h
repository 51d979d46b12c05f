// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/tables/sheet_wishes.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Adds columns for the run and the approach direction that a title above one of several tables states ("Lauf
/// 2 rückwärts"), with a note. Does nothing if the titles state no run and no direction, if they contradict
/// each other, or if a heading or a constant of the user already states the same.
void add_run_of_title(sheet::Sheet& sheet, sheet::SheetTable& table,
                      const std::vector<MappedColumn>& constants);

/// Throws InputError if a title names one axis ("Achse: Y") and the columns have the positions of one other
/// axis alone. The message has the options for both meanings. Columns that the user assigned, and an axis
/// with a constant position, are no contradiction.
void refuse_another_axis(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SheetColumn>& columns, const SheetWishes& wishes);

}  // namespace vernier::importer
