// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace vernier {

/// Letters beyond ASCII are allowed only in comments and in strings of one line of a TOML file that a board
/// reads. The parser library assumes this ("unit = µm", without quotes, is undefined in it): other letters
/// are refused before. Throws BoardError with file, line and word. setup.
void refuse_letters_outside_strings(const std::string& text, const std::string& path);

}  // namespace vernier
