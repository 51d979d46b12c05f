// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns a sentence about a few rows that are far from all others with the machine as given and a fitted
/// set-up (two points interchanged, a row of another point): the rows, their distances, and what to do. Empty
/// if no row is far, or if so many are that the rest is not the rule.
/// `posed`: returns the machine with the set-up of the given rows (fit::set_up).
std::string far_rows(const model::Measurement& measurement,
                     const std::function<model::Machine(const model::Measurement& rows)>& posed);

}  // namespace vernier::fit
