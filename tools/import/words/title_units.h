// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// True if a word of a title names deviations: "Abweichungen in µm".
bool names_deviation(const std::string& title);

/// Returns the first unit of lengths or angles in a title, in a heading without name: "Abweichungen in µm
/// (Soll-Ist)", "Abweichung in 1/1000 mm".
sheet::Heading unit_in_title(const std::string& title);

/// Unit of deviations whose headings have none, and the title that states the unit.
struct TitleUnit {
  std::string unit, title;  // both empty: no title states the unit, or two titles state different units
};

/// Returns the unit that the titles of a table state for its deviations: the unit follows the word for a
/// deviation, and no word for a position is between the two. Examples: "Abweichungen in µm", "Positionen in
/// mm, Abweichungen in µm".
TitleUnit unit_of_deviations(const sheet::Sheet& sheet, const sheet::SheetTable& table);

}  // namespace vernier::importer
