// SPDX-License-Identifier: GPL-3.0-or-later
// Functions that select the parameters and the set-ups of a fit.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tools/model/measurement.h"

namespace vernier::fit {

/// True if the parameter name `name` matches `pattern` (* stands for any letters, ? for one letter).
bool matches_pattern(std::string_view pattern, std::string_view name);

/// Returns the names of the set-ups that have at least one observation in a fit row.
std::vector<std::string> setups_of_fit_rows(const model::Measurement& measurement);

}  // namespace vernier::fit
