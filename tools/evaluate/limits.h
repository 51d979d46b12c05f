// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace vernier::evaluate {

/// "A=10um" as a characteristic and a value in `unit`, mm or deg: a length is no limit of an angle. `names`:
/// names of the known characteristics. Throws InputError with the option and its text.
std::pair<std::string, double> limit_of(const std::string& words, const std::string& option,
                                        const std::vector<std::string>& names,
                                        const std::string& unit = "mm");

}  // namespace vernier::evaluate
