// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Notes a run without a negative value whose sizes agree with those of another run, where the other run is
/// negative: the run has lost its minus signs. `runs`: the columns of the runs of one axis
/// in one approach direction and unit.
void note_unsigned_runs(sheet::Sheet& sheet, const sheet::SheetTable& table,
                        const std::vector<std::size_t>& runs);

/// Applies a column of signs ("VZ", "Vorzeichen", "Sign" with + and -) to the column of numbers at its right,
/// with a note, and empties it. A column of words with the sign of the only deviation ("zu weit" and "zu
/// kurz", "over" and "under", "plus" and "minus" in a remark) is applied too, and two columns "zu kurz" and
/// "zu lang" become one. Throws InputError if the numbers of a stated column of signs have signs of their
/// own, if a number has no sign beside it, or if words about a size stand beside positions below zero. A
/// column that an option names (`named`) is not changed.
void apply_sign_column(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<std::string>& named);

}  // namespace vernier::importer
