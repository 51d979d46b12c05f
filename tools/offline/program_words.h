// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/text/error.h"

namespace vernier::offline {

/// One word of a block: X12.5, G1, (a remark), ;a remark.
struct Word {
  char letter = 0;  // upper case; ( for remarks, % and / for themselves
  double value = 0;
  std::string text;  // unchanged
};

/// Returns the words of a block. Throws InputError for a remark without an end, and for text that is neither
/// a word nor a remark: parameters, expressions, loops.
std::vector<Word> words_of(const std::string& line, const text::Place& place);

/// Returns the value of the first word with this letter; nullopt if the block has no such word.
std::optional<double> value_of(const std::vector<Word>& words, char letter);

}  // namespace vernier::offline
