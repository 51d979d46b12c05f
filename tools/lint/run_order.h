// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tools/lint/finding.h"
#include "tools/lint/lint_table.h"

namespace vernier::lint {

/// Tests whether the deviations of one run of an axis (measured - commanded position) have the opposite sign
/// of those of all other runs at the same positions. Adds a warning at the first row of this run.
void look_at_signs_of_runs(const LintTable& table, const LintNames& names, LintFindings& findings);

}  // namespace vernier::lint
