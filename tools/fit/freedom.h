// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::fit {

/// Returns a copy of the machine in which other parameters are free than the machine file states. Patterns
/// (with * and ?) select statics (`alpha`), columns of tables (`table.X.rY`), set-ups (`BaseShift`,
/// `BaseShift[run]`) and scale factors (`scalefactor.X`). First the parameters that match `free` are freed,
/// then the parameters that match `hold` are fixed. Throws InputError for a pattern that matches no
/// parameter.
model::Machine with_freedom(const model::Machine& machine, const std::vector<std::string>& free,
                            const std::vector<std::string>& hold);

}  // namespace vernier::fit
