// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/import/columns/sheet_wishes.h"
#include "tools/sheet/heading.h"

namespace vernier::importer {

/// True if `name` is a name of the measurement format that is accepted without any change. Exception: a
/// column of numbers with a name from a later version of the format may be a column of the user.
bool is_known_name(const std::string& name);
/// True if the column `name` contains words (labels), for example `run`.
bool is_label(const std::string& name);
/// True if the column `name` contains an approach direction, for example `dirX`.
bool is_sense(const std::string& name);
/// True if the column `name` contains numbers without unit.
bool is_pure(const std::string& name);
/// True if `unit` is a unit of angles.
bool is_angle(const std::string& unit);
/// True if the column must have a unit.
bool wants_unit(const SheetColumn& column);
/// Leaves a column out of the measurement file. `why`: the reason, for the user.
void leave_column(SheetColumn& column, const std::string& why);
/// Returns the name of the reading that belongs to an axis: x, y, z for X, Y, Z (along the axis); rx, ry, rz
/// for A, B, C (about the axis); nullopt for other axes.
std::optional<std::string> reading_of(const std::string& axis);

/// True if a heading names a correction: nominal - actual, the opposite of a deviation (JCGM 200:2012, 2.53).
/// The heading "Abweichung nach Korrektur" (deviation after correction) names a deviation. A heading with its
/// own formula is a deviation too.
bool names_correction(const sheet::Heading& heading);

/// Returns the heading of a column that the import adds for the approach direction, or for the run, of each
/// row.
sheet::Heading heading_of_directions();
sheet::Heading heading_of_runs();
/// Returns the heading of a column that joins the columns of several runs: its name, and the texts of the
/// first and the last heading, by which the messages name the column.
sheet::Heading heading_of_joined(const sheet::Heading& named, const std::string& first,
                                 const std::string& last);

/// Index of the columns by name, so that the time to find a column does not depend on the number of columns.
class Readings {
 public:
  explicit Readings(const std::vector<SheetColumn>& columns) {
    for (const SheetColumn& one : columns)
      if (one.use == SheetColumn::Use::kColumn)
        header_.emplace(one.name, format::CsvColumn{one.name, one.unit});
  }
  /// True if `column` is a reading among the columns of this table.
  bool contain(const SheetColumn& column) const {
    return format::is_reading({column.name, column.unit},
                              [&](std::string_view name) -> const format::CsvColumn* {
                                const auto found = header_.find(name);
                                return found == header_.end() ? nullptr : &found->second;
                              });
  }

 private:
  std::map<std::string, format::CsvColumn, std::less<>> header_;
};

/// Finds the meaning of a column from its heading.
class Guess {
 public:
  explicit Guess(const SheetWishes& wishes) : wishes_(wishes) {}

  /// True if `word` is the name of an axis: an axis of the machine if the machine is known, otherwise a usual
  /// axis name.
  bool is_axis(const std::string& word) const;
  /// True if `word` counts as an axis only because of its letter, and may mean something else: U a voltage, A
  /// a current.
  bool may_be_no_axis(const std::string& word) const {
    return wishes_.axes.empty() && is_axis(word) && word != "X" && word != "Y" && word != "Z";
  }

  std::optional<format::AxisColumnName> of_axis(const std::string& name) const {
    return format::axis_column_named(name, [&](const std::string& axis) { return is_axis(axis); });
  }
  bool is_motion(const std::string& name) const {
    const auto column = of_axis(name);
    return column && column->quantity != format::AxisQuantity::kPosition;
  }

  /// Returns the meaning of a column by its heading alone.
  SheetColumn column(const sheet::Heading& heading) const;

  /// Returns the meaning of a component error of ISO 230-1:2012, 3.4: EYX is a deviation along Y, EBX a
  /// rotation about Y by the right-hand rule. nullopt for any other heading.
  std::optional<SheetColumn> component_error(const sheet::Heading& heading) const;

  /// Kind of a heading that names no axis: "Soll" (target), "Pos", "Istposition" (actual position), "Anzeige"
  /// (the position that the control shows, or the reading of a gauge).
  enum class Bare { kOther, kTarget, kActual, kDisplay };
  static Bare bare(const std::string& name);

 private:
  const SheetWishes& wishes_;
};

/// Returns the first column of positions by its heading; nullopt if no heading names a position.
std::optional<std::size_t> column_of_positions(const sheet::SheetTable& table);

/// True if a column has no unit, and its values are 1, 2, 3 … from row to row: the number of the row.
bool counts_rows(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column);

/// True if a column has no unit and no other values than the whole numbers 1 to n, each in any number of
/// rows: the numbers of positions.
bool numbers_positions(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column);

/// Returns the option that makes a column the positions of the axis X for a deviation whose axis is not
/// known: --column "X=Pos 1 [mm]". The nearest column to the left of the deviation has its positions, first
/// of the columns with a word for a position that do not count the rows, then of the columns in a unit of
/// length or angle; --set "X[mm]=0" if the table has none.
std::string option_of_positions(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                const std::vector<SheetColumn>& columns, const Guess& guess,
                                std::size_t deviation);

}  // namespace vernier::importer
