// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/model/machine.h"

namespace vernier::commands {

/// Prints the findings of the last fit of a machine file to standard error, one line for each finding.
void repeat_findings(const model::Machine& machine);

/// Reads a machine file and prints the findings of its last fit. Throws InputError if the machine file is not
/// valid.
model::Machine read_model(const std::string& path);

}  // namespace vernier::commands
