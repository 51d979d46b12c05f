// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/columns/sheet_columns.h"

namespace vernier::importer {

/// Notes the names of runs and points whose form differs from that of the others and that contain a word or a
/// mark: the run "Probelauf" beside 2 and 3, "2*", the point "P2 n. verw.". Numbers, single letters,
/// directions and words for runs ("S1", "forward", "1 vor") are no difference. If the names of a column have
/// no common form ("kalt", "warm"), only words for a trial are quoted.
void note_odd_names(sheet::Sheet& sheet, const sheet::SheetTable& table,
                    const std::vector<SheetColumn>& columns);

}  // namespace vernier::importer
