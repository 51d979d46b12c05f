// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/lint/finding.h"
#include "tools/lint/lint_table.h"

namespace vernier::lint {

/// Tests whether the approach directions of the column `sense` (1, -1, 0) agree with the order of the
/// positions of its axis from row to row. Adds a warning if every run along this axis alone goes against its
/// direction.
void look_at_directions(const LintTable& table, const LintColumn& sense, const LintNames& names,
                        LintFindings& findings);

/// Adds a remark for each axis that reaches the same positions from both sides, by the order of the rows, in
/// a file without its column of directions.
void look_for_missing_directions(const LintTable& table, const LintNames& names, LintFindings& findings);

}  // namespace vernier::lint
