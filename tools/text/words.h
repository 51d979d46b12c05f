// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace vernier {

/// The text without blanks, tabs and ends of line around it. tool.
std::string trimmed(std::string_view text);

/// "a,b": the words with a separator between them. tool.
std::string joined(const std::vector<std::string>& words, std::string_view separator);

}  // namespace vernier
