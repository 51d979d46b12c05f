// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/format/columns.h"
#include "tools/model/machine.h"

namespace vernier::lint {

/// A column of a measurement file, which may contain errors.
struct LintColumn {
  std::string name, unit;
  bool label = false;         // true: the column contains words, not numbers
  std::vector<double> value;  // values in the base unit; NaN for an empty cell or a word
  std::vector<std::string> cell;
};

/// One row of data in a measurement file, as its fields.
struct LintRow {
  std::vector<std::string> cells;
  std::size_t line = 0;
};

/// The readable part of a measurement file.
struct LintTable {
  std::size_t header_line = 0;
  std::vector<LintColumn> columns;
  std::vector<LintRow> rows;
  const LintColumn* find(const std::string& name) const;
};

/// Meanings of the names in a measurement file. The names are those of a machine, or the usual names (X Y Z A
/// B C U V W J1 …) if there is no machine.
class LintNames {
 public:
  explicit LintNames(const model::Machine* machine) : machine_(machine) {}
  bool is_axis(const std::string& name) const;
  /// True if the axis with the name `name` is rotary.
  bool is_rotary(const std::string& name) const;
  /// Returns the axis and the quantity of a column such as "dirX" or "X"; nullopt if the column does not
  /// belong to an axis.
  std::optional<format::AxisColumnName> of_axis(const std::string& name) const;
  bool is_of_axis(const std::string& name, format::AxisQuantity quantity) const;
  bool is_input(const std::string& name) const {
    return machine_ != nullptr && machine_->find_input(name).has_value();
  }
  /// True if a column of this table is a reading (format::is_reading).
  bool is_reading(const LintTable& table, const LintColumn& column) const;
  /// True for a table with the column of touched objects (`on`), of a machine that declares none.
  bool lacks_artefact_of(const LintTable& table) const;
  /// Returns the base unit that a column with this name must have; "" for no unit, and "?" for any unit.
  std::string needed_unit(const std::string& name) const;
  /// Returns all names that have a meaning in a measurement file.
  std::vector<std::string> known() const;

 private:
  const model::Machine* machine_;
};

/// Returns the name of a file with quotes for use in a shell command.
std::string quoted_for_shell(const std::string& file);

}  // namespace vernier::lint
