// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::fit {

/// The machine with other parameters free than its file says. Patterns (* and ?) of statics (`alpha`),
/// columns of tables (`table.X.rY`), set-ups (`BaseShift`, `BaseShift[run]`) and scale factors
/// (`scalefactor.X`): those of `free` are freed, then those of `hold` held. Throws InputError for a pattern
/// that names nothing. tool.
model::Machine with_freedom(const model::Machine& machine, const std::vector<std::string>& free,
                            const std::vector<std::string>& hold);

}  // namespace vernier::fit
