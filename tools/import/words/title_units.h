// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// True if a word of a title names deviations: "Abweichungen in µm", "Positionierabweichungen".
bool names_deviation(const std::string& title);

/// Returns the unit that a title states for deviations, in a heading without name; no unit if the title
/// states none, or several. A unit belongs to the quantity before it: in "Toleranz 8 µm, Abweichungen in mm"
/// the deviations are in mm, in "Positionen in mm, Abweichungen in µm" in µm. A unit before all quantities,
/// and "Werte in µm" or "Einheit: µm", belong to the deviations too.
sheet::Heading unit_of_deviations_in(const std::string& title);

/// Unit of columns whose headings have none, and the title that states the unit.
struct TitleUnit {
  std::string unit, title;  // both empty: no title states the unit, or two titles state different units
};

/// Returns the note that a title stated a unit. `of`: "deviations" or "positions".
std::string note_of_title_unit(const char* of, const TitleUnit& unit);

/// Units that the titles of a table state for its deviations and for its positions ("Positionen in mm", "alle
/// Werte in mm").
struct TitleUnits {
  TitleUnit deviations, positions;
};
TitleUnits units_of_titles(const sheet::Sheet& sheet, const sheet::SheetTable& table);

}  // namespace vernier::importer
