// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <string>
#include <vector>

namespace vernier::house {

/// Circles of units inside a folder: units (a header and the source of its name) that reach each other by
/// includes, as "folder: a b c", names in order. files: path from the repository root to text.
std::vector<std::string> circles_of_units(const std::map<std::string, std::string>& files);

}  // namespace vernier::house
