// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/columns/sheet_columns.h"
#include "tools/import/distances/distance_table.h"
#include "tools/import/tables/sheet_table.h"

namespace vernier::importer {

/// Options with which the user describes a spreadsheet, in the words of `vernier import table`. An empty
/// option is detected from the file.
struct SheetWords {
  std::string separator, decimal, comment, sheet, unit;
  std::string sign;        // "actual-nominal" or "nominal-actual", for all deviations
  std::string directions;  // "from-order": by the order of the rows, for axes without a column
  std::optional<std::size_t> skip, table;
  std::vector<std::string> columns, deviations, constants, left;
  std::string column_option = "--column";  // the option of `columns`, for refusals
  std::vector<std::string> fill;           // headings of columns whose empty cells have the value above them
  bool one_motion = false;
  std::vector<std::string> axes;   // axes of the machine, if the machine is known
  std::vector<std::string> found;  // headings in `columns` that the program found: no unit is stated
  NamedPoints points;              // points of a table of distances between named points
};

/// Result of reading a spreadsheet: headings, columns and their meaning, before the rows of data are
/// converted.
struct SheetReading {
  SheetWishes wishes;
  sheet::Sheet sheet;
  sheet::SheetTable table;
  std::vector<SheetColumn> columns;
  std::size_t runs = 0;  // number of columns that were joined because each was one run (unfold_runs)
  std::optional<PointDistances> distances = {};  // no value: no table of distances between named points
};

/// Reads a spreadsheet from text or from a workbook. `wishes`: the settings of a profile. Options
/// in `words` have priority over the settings of the profile. If the spreadsheet is not valid,
/// throws InputError with file, line and word.
SheetReading read_as_sheet(const std::string& bytes, const std::string& file, const SheetWords& words,
                           SheetWishes wishes = {});

/// Returns the table of a measurement file (sheet_table.h: table_of_sheet; distance_table.h: distances_of).
/// Throws InputError if the spreadsheet is not complete.
ImportTable table_of_reading(const SheetReading& reading);

/// Returns the text format of a sheet for people, for example "UTF-8, columns separated by semicolon, decimal
/// comma".
std::string how_read(const sheet::Sheet& sheet);
/// Returns a text that describes the use of a column: "x[mm]", "position of X + this, [um]", "left out".
std::string becomes(const SheetColumn& column);
/// Returns the use of all columns as JSON: [{heading, use: column deviation left, name, unit, why}]. An
/// element has also a sign if the sign of a deviation was reversed.
nlohmann::ordered_json columns_json(const SheetReading& reading);

}  // namespace vernier::importer
