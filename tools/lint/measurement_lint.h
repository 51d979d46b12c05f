// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/lint/finding.h"
#include "tools/model/machine.h"

namespace vernier::lint {

/// Tests the form of a measurement file (separator, decimal sign, encoding, header, rows) and its numbers
/// (units that do not match, an axis that never moves, decreasing time, directions that are not valid). If a
/// machine is given, lint_measurement also tests whether the file has the columns that this machine needs.
std::vector<LintFinding> lint_measurement(const std::string& bytes, const std::string& file,
                                          const model::Machine* machine);

/// Returns the command that imports a file of another kind; nullopt if the file looks like a measurement
/// file.
std::string import_command_for(const std::string& bytes, const std::string& file);

}  // namespace vernier::lint
