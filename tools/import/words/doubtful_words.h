// SPDX-License-Identifier: GPL-3.0-or-later
// Words of a text that may change the numbers of a table. Rules that read a text are elsewhere; these words
// only decide whether a text that no rule read is passed on to the user.
#pragma once
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "tools/sheet/heading.h"

namespace vernier::importer {

/// What a text beside a table may change.
enum class Doubtful {
  kSign,        // "Minus indicates overtravel"
  kIncrements,  // "Änderung gegenüber der vorigen Zeile"
  kFactor,      // "angezeigte Werte sind doppelt so groß"
  kAddition,    // "100 µm zu jedem Wert addiert"
  kInvalid,     // "Lauf 2 verworfen"
  kZero,        // "Nullpunkt der Liste bei X = 150 mm"
  kBackOrder,   // "von unten nach oben lesen"
  kUnits,       // "Positionen in Zoll"
  kDirections,  // "columns 1 to 3 approached from below"
  kCodes        // "1 = rückwärts"
};

/// Returns what a text may change, by its words (German and English). A text of a protocol without such a
/// meaning ("Positioniergenauigkeit X-Achse, Laser XL-80, 20 °C") has none.
std::set<Doubtful> doubtful_in(std::string_view text);

/// True if a text may change this.
bool may_state(std::string_view text, Doubtful subject);

/// Returns the first unit that a text names without a number before it ("Positionen in Zoll", but not
/// "Raster 0,01 mm"), of a quantity that a column of the table has, if no column has this unit: the word, and
/// the unit of the measurement file. Empty: none.
std::pair<std::string, std::string> unit_against_headings(std::string_view text,
                                                          const sheet::SheetTable& table);

}  // namespace vernier::importer
