// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/format/columns.h"
#include "tools/model/machine.h"

namespace vernier::lint {

/// A column of a measurement file, even with errors in it.
struct LintColumn {
  std::string name, unit;
  bool label = false;         // words, not numbers
  std::vector<double> value;  // in its base unit; NaN for an empty cell or a word
  std::vector<std::string> cell;
};

/// A line of data of a measurement file, as its fields.
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

/// Meanings of names in a measurement file: the names of a machine, or without a machine the usual names (X Y
/// Z A B C U V W J1 …).
class LintNames {
 public:
  explicit LintNames(const model::Machine* machine) : machine_(machine) {}
  bool is_axis(const std::string& name) const;
  /// True if the axis of this name is rotary.
  bool is_rotary(const std::string& name) const;
  /// Returns the axis and the quantity of a column such as "dirX" or "X"; nullopt: the column belongs to no
  /// axis.
  std::optional<format::AxisColumnName> of_axis(const std::string& name) const;
  bool is_of_axis(const std::string& name, format::AxisQuantity quantity) const;
  bool is_input(const std::string& name) const {
    return machine_ != nullptr && machine_->find_input(name).has_value();
  }
  /// True if a column of this table is a reading (format::is_reading).
  bool is_reading(const LintTable& table, const LintColumn& column) const;
  /// Returns the unit that a column of this name needs, as a base unit; "" no unit; "?" any unit.
  std::string needed_unit(const std::string& name) const;
  /// Returns all names that have a meaning.
  std::vector<std::string> known() const;

 private:
  const model::Machine* machine_;
};

/// A file name, quoted for use in a command.
std::string quoted_for_shell(const std::string& file);

}  // namespace vernier::lint
