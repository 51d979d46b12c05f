// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::fuzz {

/// Inputs that a target (by its name) reads well, for mutation to begin with: of the files of the tree, and
/// messages made here.
std::vector<std::string> seeds_of(const std::string& target);

}  // namespace vernier::fuzz
