// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace vernier {

/// Refuses a TOML file that has letters beyond ASCII outside comments and strings of one line. The parser
/// library is undefined for such letters ("unit = µm", without quotes); they are therefore refused before
/// parsing. Throws BoardError with file, line and word. Not real-time safe.
void refuse_letters_outside_strings(const std::string& text, const std::string& path);

}  // namespace vernier
