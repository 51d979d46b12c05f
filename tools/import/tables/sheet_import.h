// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/tables/sheet_columns.h"
#include "tools/import/tables/sheet_table.h"

namespace vernier::importer {

/// Description of a spreadsheet by the user, in the words of `vernier import table`; empty: detected.
struct SheetWords {
  std::string separator, decimal, comment, sheet, unit;
  std::optional<std::size_t> skip, table;
  std::vector<std::string> columns, deviations, constants, left;
  std::vector<std::string> fill;  // headings
  bool one_motion = false;
  std::vector<std::string> axes;  // of the machine, if it is known
};

/// A spreadsheet after it is understood: headings, columns and their meaning, without the rows of data.
struct SheetReading {
  SheetWishes wishes;
  sheet::Sheet sheet;
  sheet::SheetTable table;
  std::vector<SheetColumn> columns;
  std::size_t runs = 0;  // columns of runs that were made one (unfold_runs)
};

/// Reads text or workbook. `wishes`: the settings of a profile; `words` override them. Throws InputError with
/// file, line and word.
SheetReading read_as_sheet(const std::string& bytes, const std::string& file, const SheetWords& words,
                           SheetWishes wishes = {});

/// "UTF-8, columns separated by semicolon, decimal comma".
std::string how_read(const sheet::Sheet& sheet);
/// Returns the description of the use of a column: "x[mm]", "position of X + this, [um]", "left out".
std::string becomes(const SheetColumn& column);
/// [{heading, use: column
/// deviation
/// left, name, unit, why}], with sign if the sign of a deviation was reversed.
nlohmann::ordered_json columns_json(const SheetReading& reading);

}  // namespace vernier::importer
