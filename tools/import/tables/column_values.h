// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/tables/sheet_columns.h"

namespace vernier::importer {

/// Decides by the values what a heading such as "Messwert X [um]" leaves open: the measured position, or its
/// deviation from the target. A measured position follows the target; a deviation stays small while the axis
/// moves. Only columns recognised by their heading are changed. Throws InputError if the values contradict
/// each reading: positions in a unit that is wrong by a factor, or a deviation that follows the axis.
void settle_by_values(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                      std::vector<SheetColumn>& columns);

/// Refuses two tables that stand side by side: two blocks of columns with an empty column between them, each
/// with the target and the readings of an axis of its own. A row of the sheet is then no pose of the machine.
/// Throws InputError.
void refuse_tables_side_by_side(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                const std::vector<SheetColumn>& columns);

}  // namespace vernier::importer
