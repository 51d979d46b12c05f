// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/import/tables/column_map.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Meaning of one column of a sheet in the measurement file.
struct SheetColumn {
  enum class Use { kColumn, kDeviation, kLeft };
  Use use = Use::kColumn;
  std::string name, unit;  // of the measurement file; of a deviation its axis
  std::string why;         // "by its heading", "--column", "the profile"; of one left out the reason
  bool words = false;      // kept unchanged, a label of its rows
  bool turned = false;     // of a deviation: labelled nominal - actual, its sign is reversed
  bool to_target = false;  // of a deviation: the measured position is given, the target is computed
  bool by_values = false;  // the values decided between a position and a deviation
};

/// Columns as the user describes them: assignments by heading or number, constants, and the unit of headings
/// without a unit.
struct SheetWishes {
  struct Assignment {
    std::string heading;  // its text, its name, or a number from 1
    SheetColumn column;
    text::Place place;  // in a profile; no file for an argument
  };
  sheet::SheetFormat format;
  std::vector<Assignment> assignments;
  std::vector<MappedColumn> constants;  // "run=a", "u[um]=2"
  std::string unit;
  std::vector<std::string> axes;  // of the machine, if it is known; else X Y Z A B C U V W J1 …
  std::vector<std::string> fill;  // headings whose empty cells have the value above them
  bool one_motion = false;        // blocks of columns side by side are poses of all axes
};

/// Adds an assignment "x[mm]=X ist". "X ist=x[mm]" is also accepted, as in the other imports: the headings of
/// `table` determine which side is the heading. Throws InputError.
void assign_column(SheetWishes& wishes, const sheet::SheetTable& table, const std::string& words);
/// Adds an assignment "X[um]=Abweichung": the measured value is the position of the axis plus this deviation.
void assign_deviation(SheetWishes& wishes, const std::string& words, const text::Place& place = {});

/// A profile: the stored settings for reading tables of one form. A statement a line, # remarks:
///   separator = semicolon    decimal = comma    skip = 2    sheet = Tabelle1    unit = mm
///   column X ist = x[mm]     deviation Abw. = X[um]     leave Bemerkung     set run = a
///   fill Lauf
/// Throws InputError with file, line and word.
void read_sheet_profile(SheetWishes& wishes, const std::string& text, const std::string& file);
/// Returns a profile of the recognised columns: with it, the next file of this kind needs no further
/// settings.
std::string sheet_profile(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                          const std::vector<SheetColumn>& columns, const SheetWishes& wishes);

/// Index of the column that a user names by the text or the name of its heading, or by its number from 1;
/// npos if none is named.
std::size_t find_heading(const sheet::SheetTable& table, const std::string& words);

/// Throws InputError: no heading of the table is meant by these words of the option. It lists the headings.
[[noreturn]] void refuse_heading(const sheet::SheetTable& table, const std::string& option,
                                 const std::string& words);

}  // namespace vernier::importer
