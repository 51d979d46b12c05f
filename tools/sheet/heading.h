// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/sheet/sheet.h"

namespace vernier::sheet {

/// Converts a word in any usual spelling to a unit of the formats: "µm", "micron", "(°C)", "Grad", "inch",
/// "mm/Min.", "U/min"; brackets around the word are ignored. `nullopt` if the word is not a unit.
std::optional<std::string> unit_meant(std::string_view word);

/// Number and unit of a cell that has both: "0,5 mm", "12.5°". `nullopt` for any other cell.
std::optional<std::pair<std::string, std::string>> number_and_unit(std::string_view cell, bool decimal_comma);

/// A heading: its words without the unit, and its unit: "X [mm]", "X(mm)", "X / mm", "Temp. in °C".
struct Heading {
  std::string text;          // as written
  std::string name;          // without unit
  std::string unit;          // of the formats; empty: no unit is written
  std::string unknown_unit;  // text at the place of a unit that is not a unit
};
Heading parse_heading(std::string_view cell);

/// The parts of a sheet: title lines, headings (one line or two, a line of units below), data.
struct SheetTable {
  std::vector<Heading> headings;  // one per column; named "1", "2" … without a heading
  bool has_headings = false;
  std::size_t heading_row = 0;  // index into the sheet's rows, where has_headings
  std::size_t first_data = 0;
  std::size_t units_row = 0;             // index, 0: no such row
  std::optional<std::size_t> upper_row;  // of headings in two lines the first
};

/// A row of data: as many numbers as words, and at least one. Dates are neither.
bool is_row_of_data(const Sheet& sheet, std::size_t row);

/// Finds the parts: the first row that is mostly numbers begins the data. Throws InputError if no row does.
SheetTable parts_of_sheet(const Sheet& sheet);

/// "X ist" → "X_ist": a name of the formats from any words, umlauts and signs spelled out.
std::string name_from_words(std::string_view words);

}  // namespace vernier::sheet
