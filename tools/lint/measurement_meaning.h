// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/lint/finding.h"
#include "tools/lint/lint_table.h"

namespace vernier::lint {

/// Tests the numbers of a measurement file that can be read. The test finds axes that never move or leave
/// their travel, units that do not match, decreasing time, rows that occur twice, and wrong roles or normals.
/// `machine` may be null.
void look_at_meaning(const LintTable& table, const std::string& file, const model::Machine* machine,
                     LintFindings& findings);

/// What to do about a term of the machine whose quantity has no column in the file.
inline constexpr const char* kRecordOrHold = "record this quantity, or exclude the term from the fit (--fix)";

/// Meaning of the warning about an axis that never moves in a file.
inline constexpr const char* kAxisStands =
    "the readings do not distinguish the errors of this axis from those of the set-up";

/// Tests whether readings of a temperature input, from least_degC to most_degC, are plausible in a workshop.
/// Returns the probable unit of the readings ("degF, or a heated part (bed, spindle)?"); empty if the
/// readings are plausible.
std::string temperature_doubt(double least_degC, double most_degC);

}  // namespace vernier::lint
