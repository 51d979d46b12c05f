// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Returns the text without blanks, tabs and line ends around it.
std::string trimmed(std::string_view text);

/// Returns the text with A to Z as a to z; other characters do not change.
std::string in_small_letters(std::string_view text);

/// The words between any of the separators; several in a row count once.
std::vector<std::string> words_in(std::string_view text, std::string_view separators);

/// Returns the parts between single separators, without blanks around them; parts may be empty.
std::vector<std::string> parts_of(std::string_view text, char separator);

/// Returns the words in one text with a separator between them: "a,b".
std::string joined(const std::vector<std::string>& words, std::string_view separator);

/// Replaces each occurrence of `what`, which is not empty. Text that was put in is not searched again.
void replace_all(std::string& text, std::string_view what, std::string_view with);

/// Returns a text from an input file in a form that is safe for a terminal and for JSON. Control characters,
/// marks that change the writing direction, characters without a width and bytes that are not UTF-8 become
/// "?". upload::Client passes all texts of a board through this function.
std::string printable(std::string_view text);

/// Returns the text without characters that have no width: zero width spaces and joiners, soft hyphens, byte
/// order marks. Web pages and text programs leave them in copied tables.
std::string without_invisible(std::string_view text);

/// Returns the text with blanks in place of the blanks of typesetting (no-break, thin). Between two digits
/// they stay: there they separate thousands.
std::string with_plain_blanks(std::string_view text);

/// Returns a word of a file as a message quotes it: printable, and shortened if it is longer than
/// kMostQuotedBytes.
std::string quotable(std::string_view word);
constexpr std::size_t kMostQuotedBytes = 200;

/// Returns a message as a terminal shows it: each line printable, and shortened if it is longer than
/// kMostMessageBytes. The function that prints the messages of all commands uses this function, because a
/// file name may contain any characters.
std::string shown_message(std::string_view message);
constexpr std::size_t kMostMessageBytes = 4000;

/// Returns the text with "?" in place of each byte that is not UTF-8.
std::string utf8_only(std::string_view text);

/// True if the brackets of a JSON text nest deeper than `most`. Text in strings does not count. Call
/// nests_deeper_than before the parser for any text from outside. Deep nesting would exhaust the stack of the
/// parser, or of code that walks its tree.
bool nests_deeper_than(std::string_view json, std::size_t most);
constexpr std::size_t kMostJsonDepth = 64;

}  // namespace vernier::text
