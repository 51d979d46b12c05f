// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace vernier::evaluate {

/// Reads a limit such as "A=10um": the characteristic, and its value in `unit` (mm or deg). A length is not
/// permitted as the limit of an angle. `names`: names of the known characteristics. Throws InputError with
/// the name of the option and its text.
std::pair<std::string, double> limit_of(const std::string& words, const std::string& option,
                                        const std::vector<std::string>& names,
                                        const std::string& unit = "mm");

}  // namespace vernier::evaluate
