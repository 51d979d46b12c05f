// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::fuzz {

/// Of the targets that take messages or images: a whole session each.
std::vector<std::string> binary_seeds_of(const std::string& target);

}  // namespace vernier::fuzz
