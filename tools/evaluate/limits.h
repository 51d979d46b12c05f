// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace vernier::evaluate {

/// "A=10um" as a characteristic and a value in mm or deg. `names`: those that there are. Throws InputError
/// with the option and its words. tool.
std::pair<std::string, double> limit_of(const std::string& words, const std::string& option,
                                        const std::vector<std::string>& names);

}  // namespace vernier::evaluate
