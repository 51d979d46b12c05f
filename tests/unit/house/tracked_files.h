// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

namespace vernier::house {

/// Paths of the tracked files that stand in the working tree, from the repository root; empty outside a
/// checkout.
std::vector<std::string> tracked_files();

/// The text of a file of the repository.
std::string text_of(const std::string& path);

}  // namespace vernier::house
