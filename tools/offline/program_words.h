// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/text/error.h"

namespace vernier::offline {

/// One word of a block of a part program: X12.5, G1, (a comment), ;a comment.
struct Word {
  char letter = 0;  // upper case letter; ( for comments; % and / for themselves
  double value = 0;
  std::string text;  // text of the word without change
};

/// Returns the words of a block of a part program. Throws InputError for a comment without an end, and for
/// text that is neither a word nor a comment: parameters, expressions, loops.
std::vector<Word> words_of(const std::string& line, const text::Place& place);

/// Returns the value of the first word with the letter `letter`; nullopt if the block has no such word.
std::optional<double> value_of(const std::vector<Word>& words, char letter);

}  // namespace vernier::offline
