// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/lint/finding.h"
#include "tools/lint/lint_table.h"

namespace vernier::lint {

/// Tests the numbers of a measurement file whose form can be read: axes that never move or leave their
/// travel, units that do not match, decreasing time, rows that occur twice, roles, normals. machine may be
/// null. tool.
void look_at_meaning(const LintTable& table, const std::string& file, const model::Machine* machine,
                     LintFindings& findings);

/// A temperature input whose readings, from least to most degC, are not plausible in a workshop: the probable
/// unit ("degF?"); empty: plausible. tool.
std::string temperature_doubt(double least_degC, double most_degC);

}  // namespace vernier::lint
