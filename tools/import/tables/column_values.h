// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/tables/sheet_wishes.h"

namespace vernier::importer {

/// A heading such as "Messwert X [um]" does not state whether the column has measured positions or deviations
/// from the target. This function decides by the values. A measured position follows the target; a deviation
/// stays small while the axis moves. Readings are changed only if their heading gave their meaning. Throws
/// InputError if the values contradict each reading: positions in a unit that is wrong by a factor,
/// deviations that follow the axis (also if the user stated them), or values that are neither.
void settle_by_values(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                      std::vector<SheetColumn>& columns);

/// Refuses what may be two tables side by side: two blocks of columns, each with the target and the readings
/// of its own axis, and both targets change from row to row. A row of the sheet is then perhaps no pose of
/// the machine. Throws InputError.
void refuse_tables_side_by_side(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                const std::vector<SheetColumn>& columns);

}  // namespace vernier::importer
