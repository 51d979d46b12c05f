// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/import/columns/column_map.h"
#include "tools/import/sizes/deviation_sizes.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Meaning that one column of a sheet has in the measurement file.
struct SheetColumn {
  enum class Use { kColumn, kDeviation, kLeft };
  Use use = Use::kColumn;
  std::string name, unit;  // name and unit in the measurement file; for a deviation, the name of its axis
  std::string why;         // reason for this meaning: "by its heading", "--column", "the profile"; for a
                           // column that is left out, the reason
  bool words = false;      // true: the column is a label of its rows and is not changed
  bool turned = false;     // true for a deviation with a heading nominal - actual, so that its sign is
                           // reversed
  bool to_target = false;  // true for a deviation whose measured position is given, so that the target
                           // position is computed
  bool by_values = false;  // true: the values determined whether the column is a position or a deviation
  text::Place sign_place = {};   // place of a text that states the sign of this deviation, but not clearly
  std::string sign_text = {};    // this text; empty: the sign is clear
  bool sign_of_row = false;      // true: this text is a remark of some rows
  text::Place doubt_place = {};  // place of a value that contradicts the unit or the direction of this column
  std::string doubt_word = {}, doubt = {};  // this word, and why the table is refused; empty: no doubt
  std::string unit_from = {};  // title that states the unit of this deviation; empty: no title does
  std::string sign_from = {};  // text outside the headings that states the sign of this deviation clearly
};

/// Word of the option --directions: an axis without a column of directions has that of its last motion.
inline constexpr const char* kFromOrder = "from-order";

/// Description of the columns by the user: assignments by heading or number, constants, and the unit of
/// headings without a unit.
struct SheetWishes {
  struct Assignment {
    std::string heading;  // text or name of the heading, or the number of the column from 1
    SheetColumn column;
    text::Place place;  // line of a profile; an argument of the command line has no file
  };
  sheet::SheetFormat format;
  std::vector<Assignment> assignments;
  std::vector<MappedColumn> constants;  // constants such as "run=a", "u[um]=2"
  std::string unit;
  std::vector<std::string> axes;  // axes of the machine if it is known, otherwise X Y Z A B C U V W J1 …
  std::vector<std::string> fill;  // headings whose empty cells have the value above them
  std::optional<bool> turned;     // sign of all deviations as the user states it: true: nominal - actual
  PlausibleDeviation plausible;   // largest plausible deviations, as the user states them
  bool one_motion = false;        // true: columns of several axes side by side are poses of all axes together
  bool directions_from_order = false;  // true: an axis without a column of directions has that of its last
                                       // motion, by the order of the rows
};

/// Adds an assignment of the form "x[mm]=X ist" (name=heading). The form "X ist=x[mm]" is also accepted, as
/// in the other imports. The headings of `table` determine which side is the heading. Throws InputError if
/// the text is not an assignment. `option`: the option that has these words, for the error message.
void assign_column(SheetWishes& wishes, const sheet::SheetTable& table, const std::string& words,
                   const std::string& option = "--column");
/// Adds an assignment of a deviation, for example "X[um]=Abweichung". The measured value is then the position
/// of the axis plus this deviation. A size alone ("20mm", "2deg") is the largest plausible deviation of all
/// columns.
void assign_deviation(SheetWishes& wishes, const std::string& words, const text::Place& place = {});

/// Reads a profile: the stored settings for tables with the same form. A profile has one statement in each
/// line; comments begin with #:
///   separator = semicolon    decimal = comma    skip = 2    sheet = Tabelle1    unit = mm
///   column X ist = x[mm]     deviation Abw. = X[um]     leave Bemerkung     set run = a
///   fill Lauf                sign = nominal-actual     directions = from-order
/// If the profile is not valid, throws InputError with file, line and word.
void read_sheet_profile(SheetWishes& wishes, const std::string& text, const std::string& file);
/// Returns true for "nominal-actual" and false for "actual-nominal". Throws InputError for other words.
bool turned_of(const std::string& words, const text::Place& place = {});
/// Returns a profile with the recognised columns. With this profile the next file of the same form needs no
/// further settings.
std::string sheet_profile(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                          const std::vector<SheetColumn>& columns, const SheetWishes& wishes);

/// Returns the index of the column that a user names by the text or the name of its heading, or by its number
/// from 1; npos if there is no such column.
std::size_t find_heading(const sheet::SheetTable& table, const std::string& words);

/// Throws InputError because the words of an option match no heading of the table. The error message lists
/// the headings of the table.
[[noreturn]] void refuse_heading(const sheet::SheetTable& table, const std::string& option,
                                 const std::string& words);

}  // namespace vernier::importer
