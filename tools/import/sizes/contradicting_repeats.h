// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/import/sizes/sized_column.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Two readings at one position that cannot both be right.
struct ContradictingRepeats {
  std::size_t far = 0, other = 0;  // indices: the reading that is far from all others, and its nearest repeat
};

/// Returns the readings that contradict the other readings of their group. `group`: one number for each
/// reading, equal for readings at one position and direction. A machine with play, drift or heat makes many
/// groups differ: readings are returned if they are few, and if they are far beyond the differences of the
/// other groups or beyond the range of the other readings. Limits: the constants in the source.
std::vector<ContradictingRepeats> contradicting_repeats(const std::vector<double>& values,
                                                        const std::vector<std::size_t>& group);

/// Notes the cells of contradicting_repeats(); both rows are read.
void note_contradicting_repeats(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                const std::vector<SizedColumn>& columns);

}  // namespace vernier::importer
