// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/sizes/sized_column.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Compares the measured positions with the target positions row by row: few rows that are far from their
/// target, while the other rows are not, have a wrong cell (450 mm typed as 405 or 4500). Returns at most one
/// doubt for each column of measured positions. A column that the user stated in an option gets a note in
/// `sheet` instead. Limits: the constants in the source, with their reasons.
std::vector<SizeDoubt> judge_measured_positions(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                                const std::vector<SizedColumn>& columns);

/// Removes whole turns between measured and target positions of rotary axes in deg: a display goes from 360
/// to 0 within a turn (359.999 at the target 0). `sheet` gets a note.
void remove_whole_turns(sheet::Sheet& sheet, const sheet::SheetTable& table,
                        const std::vector<SizedColumn>& columns);

/// Compares the positions of rotary axes with their unit: degrees under a heading in rad, and radians under a
/// heading in deg, also from another zero. Returns at most one doubt for each column whose unit the user did
/// not state. `sheet` gets a note if the joints of a robot in deg move by less than a half turn in rad.
std::vector<SizeDoubt> judge_angle_units(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                         const std::vector<SizedColumn>& columns);

/// Compares the motion of linear axes in a unit below the millimetre with their deviations: positions of 0 to
/// 500 under a heading in um are those of a machine of half a millimetre. Returns a doubt if the motion is
/// longer than that of a piezo stage and the deviations are more than 0.5 % of it; otherwise `sheet` gets a
/// note.
std::vector<SizeDoubt> judge_small_motions(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                           const std::vector<SizedColumn>& columns);

}  // namespace vernier::importer
