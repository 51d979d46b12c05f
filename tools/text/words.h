// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// The text without blanks, tabs and ends of line around it. tool.
std::string trimmed(std::string_view text);

/// A to Z as a to z; all else stays. tool.
std::string in_small_letters(std::string_view text);

/// The words between any of the separators; several in a row count once. tool.
std::vector<std::string> words_in(std::string_view text, std::string_view separators);

/// The parts between single separators, without blanks around them; parts may be empty. tool.
std::vector<std::string> parts_of(std::string_view text, char separator);

/// "a,b": the words with a separator between them. tool.
std::string joined(const std::vector<std::string>& words, std::string_view separator);

/// A text from outside as it may be shown on a terminal and written to JSON: control characters, marks that
/// change the writing direction and bytes that are not UTF-8 become "?". Texts of a board come through this
/// function (upload::Client). tool.
std::string printable(std::string_view text);

/// True if the brackets of a JSON text nest deeper than `most`. Text in strings does not count. Call this
/// before the parser for any text from outside: deep nesting would exhaust the stack of the parser, or of
/// code that walks its tree.
bool nests_deeper_than(std::string_view json, std::size_t most);
constexpr std::size_t kMostJsonDepth = 64;

}  // namespace vernier::text
