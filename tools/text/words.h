// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Returns the text without blanks, tabs and line ends around it. tool.
std::string trimmed(std::string_view text);

/// Converts A to Z to a to z. Other characters do not change. tool.
std::string in_small_letters(std::string_view text);

/// Returns the words between any of the separators. Several in succession count once. tool.
std::vector<std::string> words_in(std::string_view text, std::string_view separators);

/// Returns the parts between single separators, without surrounding blanks. Parts may be empty.
/// tool.
std::vector<std::string> parts_of(std::string_view text, char separator);

/// Returns "a,b": the words with a separator between them. tool.
std::string joined(const std::vector<std::string>& words, std::string_view separator);

/// Is the nesting of brackets in a JSON text deeper than `most`? Brackets in strings do not count.
/// Works for any text. It is called before the parser, so that no input exhausts the stack of the
/// parser or of functions that walk its tree.
bool nests_deeper_than(std::string_view json, std::size_t most);
constexpr std::size_t kMostJsonDepth = 64;

}  // namespace vernier::text
