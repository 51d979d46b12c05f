// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/lint/finding.h"
#include "tools/lint/lint_table.h"

namespace vernier::lint {

/// What the numbers of a measurement file say, where its form can be read: axes that never move or leave
/// their travel, units that do not go together, time that falls, rows twice, roles, normals. machine may be
/// null. tool.
void look_at_meaning(const LintTable& table, const std::string& file, const model::Machine* machine,
                     LintFindings& findings);

/// A temperature input whose readings, from least to most degC, are none of a workshop: what else they may
/// be ("degF?"); empty: no doubt. tool.
std::string temperature_doubt(double least_degC, double most_degC);

}  // namespace vernier::lint
