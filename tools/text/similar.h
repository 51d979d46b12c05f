// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Returns the distance between two words (Damerau and Levenshtein): the number of letters that must be
/// changed, inserted, removed or exchanged with a neighbour, each letter once. Capital and small letters are
/// equal in this comparison.
std::size_t letters_apart(std::string_view a, std::string_view b);

/// Returns the word of `known` that the user probably meant: the nearest word, if its distance is small
/// enough for its length.
std::optional<std::string> word_meant(std::string_view word, const std::vector<std::string>& known);

}  // namespace vernier::text
