// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/import/tables/sheet_wishes.h"
#include "tools/sheet/heading.h"

namespace vernier::importer {

/// True for a name of the measurement file that is accepted as it is written. Numbers under a name of a later
/// version of the format may be a user's column.
bool is_known_name(const std::string& name);
/// True for a column of words, such as `run`.
bool is_label(const std::string& name);
/// True for an approach direction, such as `dirX`.
bool is_sense(const std::string& name);
/// True for a column that is a pure number.
bool is_pure(const std::string& name);
/// True for a unit of angles.
bool is_angle(const std::string& unit);
/// True if a column needs a unit.
bool wants_unit(const SheetColumn& column);
/// Returns the name of the reading along or about an axis: x, y, z of X, Y, Z; rx, ry, rz of A, B, C; nullopt
/// for other axes.
std::optional<std::string> reading_of(const std::string& axis);

/// True if a heading names a correction, the opposite of a deviation: nominal - actual (JCGM 200:2012, 2.53).
/// "Abweichung nach Korrektur" is a deviation, and so is a column that states its formula.
bool names_correction(const sheet::Heading& heading);

/// Names of columns, to find each in a time that does not depend on their number.
class Readings {
 public:
  explicit Readings(const std::vector<SheetColumn>& columns) {
    for (const SheetColumn& one : columns)
      if (one.use == SheetColumn::Use::kColumn)
        header_.emplace(one.name, format::CsvColumn{one.name, one.unit});
  }
  /// Is a column a reading among these?
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

/// The meaning of a column by its heading.
class Guess {
 public:
  explicit Guess(const SheetWishes& wishes) : wishes_(wishes) {}

  /// True for the name of an axis: of the machine if it is known, else a usual name.
  bool is_axis(const std::string& word) const;
  /// Taken for an axis by its letter alone: U may be a voltage, A a current.
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

  /// Words of a heading that names no axis: "Soll", "Pos", "Istposition".
  enum class Bare { kOther, kTarget, kActual };
  static Bare bare(const std::string& name);

 private:
  const SheetWishes& wishes_;
};

}  // namespace vernier::importer
