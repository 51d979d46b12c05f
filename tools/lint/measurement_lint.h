// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/lint/finding.h"
#include "tools/model/machine.h"

namespace vernier::lint {

/// Looks at a measurement file as a whole: how it is written (separator, decimal sign, encoding, header,
/// rows), what its numbers say (units that do not go together, an axis that never moves, time that falls,
/// directions that are none), and, where a machine is given, whether it has what the machine needs. tool.
std::vector<LintFinding> lint_measurement(const std::string& bytes, const std::string& file,
                                          const model::Machine* machine);

/// The command that reads a file of another kind, or nothing where it is a measurement file by its looks.
/// tool.
std::string import_command_for(const std::string& bytes, const std::string& file);

}  // namespace vernier::lint
