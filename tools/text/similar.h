// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::text {

/// Returns the number of letters that must be changed, inserted, removed or swapped with a
/// neighbour to convert one word into the other (Damerau and Levenshtein, each letter touched
/// once). Capitals count as their small letters. tool.
std::size_t letters_apart(std::string_view a, std::string_view b);

/// Returns the word that was probably meant: the nearest of `known`, if it is near enough for its
/// length. tool.
std::optional<std::string> word_meant(std::string_view word, const std::vector<std::string>& known);

}  // namespace vernier::text
