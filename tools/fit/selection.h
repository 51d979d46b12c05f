// SPDX-License-Identifier: GPL-3.0-or-later
// Which parameters and which set-ups a fit is about.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tools/model/measurement.h"

namespace vernier::fit {

/// True if `name` matches `pattern` (* any letters, ? one letter).
bool matches_pattern(std::string_view pattern, std::string_view name);

/// Returns the set-ups that have an observation with role fit.
std::vector<std::string> setups_of_fit_rows(const model::Measurement& measurement);

}  // namespace vernier::fit
