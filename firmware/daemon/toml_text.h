// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace vernier {

/// Letters beyond ASCII stand in comments and in strings of one line, and nowhere else in a TOML file that a
/// board reads. The library that parses it takes what they are for granted ("unit = µm", without quotes, is
/// undefined in it): they are refused before. Throws BoardError with file, line and word. setup.
void refuse_letters_outside_strings(const std::string& text, const std::string& path);

}  // namespace vernier
