// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/sheet/sheet.h"

namespace vernier::sheet {

/// Converts a unit in any usual spelling to a unit of the file formats: "µm", "micron", "(°C)", "Grad",
/// "inch", "mm/Min.", "U/min". Brackets around the unit are ignored. The function unit_meant() returns
/// nullopt if the word is not a unit.
std::optional<std::string> unit_meant(std::string_view word);

/// Returns the number and the unit of a cell that contains both: "0,5 mm", "12.5°". The function
/// number_and_unit() returns nullopt for a cell that does not contain a number and a unit.
std::optional<std::pair<std::string, std::string>> number_and_unit(std::string_view cell, bool decimal_comma);

/// A heading of a column, separated into its words and its unit: "X [mm]", "X(mm)", "X / mm", "Temp. in °C".
struct Heading {
  std::string text;          // text of the heading without change
  std::string name;          // words of the heading without the unit
  std::string unit;          // unit in the form of the file formats; empty if the heading has no unit
  std::string unknown_unit;  // text at the position of a unit, if this text is not a unit
  bool joined = false;  // true: the column joins the columns of several runs, and `text` names two of them
};
Heading parse_heading(std::string_view cell);

/// Parts of a sheet: title lines, headings (in one or two lines, possibly with a line of units below), rows
/// of data.
struct SheetTable {
  std::vector<Heading> headings;  // one heading per column; "1", "2" … if the sheet has no headings
  bool has_headings = false;
  std::size_t heading_row = 0;  // index of the row with the headings, if has_headings is true
  std::size_t first_data = 0;
  std::size_t units_row = 0;             // index of the row with the units; 0: there is no such row
  std::optional<std::size_t> upper_row;  // if the headings have two lines, index of the first line
};

/// True if all cells of a row that are not empty are units.
bool is_line_of_units(const Sheet& sheet, std::size_t row);

/// True if a row is a row of data: it contains at least one number, and at least as many numbers as words.
/// Dates count neither as numbers nor as words. A row above a line of units is a row of headings.
bool is_row_of_data(const Sheet& sheet, std::size_t row);

/// Moves a line of units between two lines of headings (names, units, runs) below them, where
/// parts_of_sheet() reads it. Other sheets do not change.
void move_units_below_headings(Sheet& sheet);

/// Finds the parts of a sheet. The first row with mostly numbers is the first row of data. Throws InputError
/// if no row has mostly numbers.
SheetTable parts_of_sheet(const Sheet& sheet);

/// Converts words to a name that the file formats permit: "X ist" becomes "X_ist". Umlauts and signs are
/// written with letters.
std::string name_from_words(std::string_view words);

}  // namespace vernier::sheet
