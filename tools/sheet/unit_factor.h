// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace vernier::sheet {

/// A factor of a unit: "1/100", "0,01", "Hundertstel", "10^-2", "x 0,01", "Skt 0,002".
struct UnitFactor {
  std::size_t begin = 0;  // where it begins in its text
  double value = 0;       // 0: the text does not state the factor clearly ("Skt", "x1000")
};

/// The factor at the end of a text that stands before a unit. A whole number is a factor only after "in", x
/// or a word for divisions, so "Lauf 1" and "X 500" have none. nullopt: no factor.
/// bare: the unit has no brackets; then a whole number behind the letter of an axis is a factor too, as in
/// "Abweichung X 2 um".
std::optional<UnitFactor> factor_at_end(std::string_view text, bool bare = false);

/// The factor that a text behind a unit consists of: "in Hundertstel", "x1000", "(1/100)"; nullopt otherwise.
std::optional<UnitFactor> factor_behind(std::string_view text);

/// True if a unit has a factor beside it, before or behind it: "0,5 um", "mm x1000", "um/100".
bool has_factor(std::string_view unit);

/// True if a text has a word that is a factor of a unit, at any place: "Messuhr 1/100", "Skt".
bool names_factor(std::string_view text);

/// The unit that is `factor` times the unit; nullopt if the formats do not have it.
std::optional<std::string> unit_times(double factor, std::string_view unit);

}  // namespace vernier::sheet
