// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Returns a text without leading and trailing blanks, tabs and line ends.
std::string trimmed(std::string_view text);

/// Returns a text in small letters: A to Z and, in UTF-8, À to Þ. Other characters do not change.
std::string in_small_letters(std::string_view text);

/// Returns the words between any of the separators. Several successive separators count as one.
std::vector<std::string> words_in(std::string_view text, std::string_view separators);

/// Returns the parts of a text between single separators, without leading and trailing blanks. Parts may be
/// empty.
std::vector<std::string> parts_of(std::string_view text, char separator);

/// Returns several words as one text with a separator between them: "a,b".
std::string joined(const std::vector<std::string>& words, std::string_view separator);

/// Replaces each occurrence of `what` (not empty) by `with`. The inserted text `with` is not searched for
/// `what` again.
void replace_all(std::string& text, std::string_view what, std::string_view with);

/// Returns a text from an input file in a form that is safe for a terminal and for JSON. Control characters,
/// characters that change the writing direction, characters without a width, and bytes that are not UTF-8 are
/// replaced by "?". upload::Client uses this function for all texts of a board.
std::string printable(std::string_view text);

/// Returns a text without characters that have no width: zero width spaces and joiners, soft hyphens, byte
/// order marks. Characters without a width are often in tables that are copied from web pages and text
/// programs.
std::string without_invisible(std::string_view text);

/// Returns a text in which ordinary blanks replace typographic blanks (no-break, thin). A typographic blank
/// between two digits is not replaced, because it separates thousands.
std::string with_plain_blanks(std::string_view text);

/// Returns a word of a file in the form for a message: printable, and shortened if it is longer than
/// kMostQuotedBytes.
std::string quotable(std::string_view word);
constexpr std::size_t kMostQuotedBytes = 200;

/// Returns a message in the form for a terminal: each line is printable, and is shortened if it is longer
/// than kMostMessageBytes. All commands print their messages through this function, because a file name may
/// contain any characters.
std::string shown_message(std::string_view message);
constexpr std::size_t kMostMessageBytes = 4000;

/// Returns a text in which "?" replaces each byte that is not UTF-8.
std::string utf8_only(std::string_view text);

/// True if the brackets of a JSON text are nested deeper than `most`. Brackets in strings are not counted.
/// Call nests_deeper_than before a JSON text from outside is parsed. Deep nesting would exhaust the stack of
/// the parser, or of code that processes the parsed tree.
bool nests_deeper_than(std::string_view json, std::size_t most);
constexpr std::size_t kMostJsonDepth = 64;

}  // namespace vernier::text
