// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/parameters.h"

namespace vernier::workbench {

/// Returns the free parameters of a machine with all its BaseShifts: those of each run or set-up, and the
/// BaseShift without `run` and `setup`.
model::ParameterSet all_parameters(const model::Machine& machine);

/// Sets parameters of a machine by name (names as in the result of fit). Hidden statics can be set too.
/// Throws InputError if the machine has no parameter with one of the names.
void set_values(model::Machine& machine, const std::map<std::string, double>& values);

}  // namespace vernier::workbench
