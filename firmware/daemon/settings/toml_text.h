// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace vernier {

/// Checks that a TOML file has letters beyond ASCII only in comments and in strings of one line. The
/// behaviour of the parser library is undefined for other letters beyond ASCII ("unit = µm", without quotes).
/// The letters of the file are therefore checked before parsing. If a letter beyond ASCII is found outside
/// quotes, throws BoardError with file, line and word. Not real-time safe.
void refuse_letters_outside_strings(const std::string& text, const std::string& path);

}  // namespace vernier
