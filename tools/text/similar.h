// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Returns the distance of two words (Damerau and Levenshtein): how many letters must be changed, inserted,
/// removed or swapped with a neighbour, each letter once. Capitals count as small letters.
std::size_t letters_apart(std::string_view a, std::string_view b);

/// Returns the word of `known` that was probably meant: the nearest word, if it is near enough for its
/// length.
std::optional<std::string> word_meant(std::string_view word, const std::vector<std::string>& known);

}  // namespace vernier::text
