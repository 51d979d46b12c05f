// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/columns/sheet_wishes.h"

namespace vernier::importer {

/// Splits a column of runs with directions ("1+", "1-", "2 hin") into a column of runs and a column of
/// approach directions. A table with a column of approach directions does not change.
void split_runs(sheet::Sheet& sheet, sheet::SheetTable& table);

/// Writes the approach directions of a column with two codes as 1 and -1: 0 and 1, 1 and 2, V and R, li and
/// re, words such as hin and zurück. If the positions increase from row to row with one code, and decrease
/// with the other one, the positions decide. Otherwise V, H, F and the words forward, hin, vor are the
/// direction of increasing positions, and 1 beside 0 or 2 is that direction with a note. The signs + and -,
/// the numbers 1 and -1 and the words up and down keep their meaning; if the order of the rows contradicts
/// both of them, the column gets a doubt (table_of_sheet refuses it) unless the user assigned it, and
/// otherwise a note. Codes without a usual meaning (li, re) remain unchanged if the positions do not decide.
/// `unfolded`: the rows come from columns side by side, and their order shows no direction.
void settle_directions(sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                       bool unfolded);

}  // namespace vernier::importer
