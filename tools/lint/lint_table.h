// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/format/columns.h"
#include "tools/model/machine.h"

namespace vernier::lint {

/// A column of a measurement file, also if it has errors.
struct LintColumn {
  std::string name, unit;
  bool label = false;         // words, not numbers
  std::vector<double> value;  // in its base unit; NaN for an empty cell or a word
  std::vector<std::string> cell;
};

/// A line that counts, as its fields.
struct LintRow {
  std::vector<std::string> cells;
  std::size_t line = 0;
};

/// A measurement file as far as it can be read.
struct LintTable {
  std::size_t header_line = 0;
  std::vector<LintColumn> columns;
  std::vector<LintRow> rows;
  const LintColumn* find(const std::string& name) const;
};

/// Meanings of names in a measurement file: of a machine, or without a machine of any (X Y Z A B C U V W J1
/// …).
class LintNames {
 public:
  explicit LintNames(const model::Machine* machine) : machine_(machine) {}
  bool is_axis(const std::string& name) const;
  /// Of a name that is an axis.
  bool is_rotary(const std::string& name) const;
  /// The axis and the quantity of a column such as "dirX" or "X"; nullopt: a column of no axis.
  std::optional<format::AxisColumnName> of_axis(const std::string& name) const;
  bool is_of_axis(const std::string& name, format::AxisQuantity quantity) const;
  bool is_input(const std::string& name) const {
    return machine_ != nullptr && machine_->find_input(name).has_value();
  }
  /// True if a column of this table is a reading (format::is_reading).
  bool is_reading(const LintTable& table, const LintColumn& column) const;
  /// The unit that a column of this name needs, as a base unit; "" without a unit; "?" any.
  std::string needed_unit(const std::string& name) const;
  /// All names that mean something.
  std::vector<std::string> known() const;

 private:
  const model::Machine* machine_;
};

/// A file name, quoted for use in a command.
std::string quoted_for_shell(const std::string& file);

}  // namespace vernier::lint
