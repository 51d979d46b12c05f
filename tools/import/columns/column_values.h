// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/columns/sheet_wishes.h"

namespace vernier::importer {

/// Determines from the values whether a column contains measured positions or deviations, because a heading
/// such as "Messwert X [um]" does not state this. A measured position follows the target position. A
/// deviation stays small while the axis moves. A reading is changed only if its heading gave its meaning (not
/// the user). Throws InputError if the values fit neither meaning: positions whose unit is wrong by a factor,
/// deviations that follow the axis (also if the user stated them), or values that are neither positions nor
/// deviations.
void settle_by_values(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                      std::vector<SheetColumn>& columns);

/// Returns the end of a message about a cell with the other decimal sign than the table is read with.
std::string other_decimal_sign(const sheet::Sheet& sheet);

/// Throws InputError if the sheet may contain two tables side by side. Two tables side by side have two
/// blocks of columns, each with target and readings of its own axis, and both targets change from row to row.
/// In a sheet with two tables side by side, a row is perhaps not a pose of the machine.
void refuse_tables_side_by_side(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                const std::vector<SheetColumn>& columns);

}  // namespace vernier::importer
