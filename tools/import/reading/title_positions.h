// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/import/columns/sheet_wishes.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Position at which an axis stands still, as a text beside the table states it.
struct TitlePosition {
  std::string axis, number, unit;  // "X", "250,5" as the file writes it, "mm"; unit: empty if not stated
  bool read = true;                // false: the text has a number beside the axis in a form that is not clear
};

/// Returns the positions of axes in a title: "Achse Y bei X=250 mm", "Y axis, X 250", "Z: 100 mm". A range
/// ("X 0 bis 500"), a list, a travel ("Verfahrweg X=500") and a result in um ("B = 3 µm") are no positions.
/// A rotary axis needs a unit of angles, or a word such as "bei". `wishes`: has the axes of the machine.
std::vector<TitlePosition> positions_in_title(const std::string& title, const SheetWishes& wishes);

/// Adds the positions in the titles to the constants of `wishes`, with a note for each, for axes that have no
/// column and no constant. A number beside an axis that is not clear, and a position in a text that may be
/// about another table, get a note with the option --set. Throws InputError if two titles state two positions
/// of one axis.
void add_positions_of_titles(sheet::Sheet& sheet, const sheet::SheetTable& table, SheetWishes& wishes);

}  // namespace vernier::importer
