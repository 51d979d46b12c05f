// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace vernier::house {

// A unit is a header and the source of its name. A room is a second-level folder (tools/fit) with the folders
// below it. files: path from the repository root to text.

/// Circles of units inside a room: units that include each other, directly or through others, as
/// "tools/fit/a tools/fit/b", names in order.
std::vector<std::string> circles_of_units(const std::map<std::string, std::string>& files);

/// Circles of folders inside a room, in the same form: a folder includes those below it, or they include it.
std::vector<std::string> circles_of_folders(const std::map<std::string, std::string>& files);

/// How many units each folder holds, without the folders below it.
std::map<std::string, std::size_t> units_in_folders(const std::map<std::string, std::string>& files);

}  // namespace vernier::house
