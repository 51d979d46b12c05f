// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tools/format/csv_file.h"

namespace vernier::probe {

/// Touches of a probe as a table. Columns are found by name, the feed as `feed[mm/min]` or `feed_mm_min`;
/// lengths may have any unit.
class TouchTable {
 public:
  /// `renames`: "column=name" or "column=name[unit]"; `where`: "column=value" selects the rows that are kept.
  /// If the file is not valid, throws InputError with file, line and word.
  TouchTable(const std::string& text, const std::string& file, const std::vector<std::string>& renames,
             const std::vector<std::string>& where);

  /// Returns the rows that have the value `value` in the column `column` (with its name in the file). Throws
  /// InputError if the column does not exist.
  TouchTable only(const std::string& column, const std::string& value) const;
  /// Returns the values of a column, in the order of the file. Throws InputError if the column does not
  /// exist.
  std::vector<std::string> values_of(const std::string& column) const;

  std::size_t rows() const { return csv_.rows.size(); }
  const std::string& file() const { return csv_.file; }
  std::size_t line(std::size_t row) const { return csv_.line[row]; }
  const format::CsvFile& csv() const { return csv_; }

  /// Returns the numbers of a column in base units (mm, deg, s, degC; mm/min is not changed); nullopt if no
  /// column has one of the names. Throws InputError if a cell is not a number. The first of the names for
  /// which a column exists is used. If two columns differ only by the suffix "_printed", the column with the
  /// suffix is used, and a note reports this.
  std::optional<Eigen::VectorXd> find(const std::vector<std::string>& names);
  /// Returns the numbers of a required column. Throws InputError if the column is missing. `what`: purpose of
  /// the column, for the message.
  Eigen::VectorXd need(const std::vector<std::string>& names, const std::string& what);
  /// Returns the column u, mm. Throws InputError if a standard uncertainty u is not above 0.
  std::optional<Eigen::VectorXd> uncertainty();

  /// Returns notes about decisions that were made while the file was read.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Column {
    std::string name, unit;  // name without the unit
    bool printed = false;
    std::size_t index = 0;
  };
  std::vector<Column> columns_;
  format::CsvFile csv_;
  std::vector<std::string> notes_;
};

}  // namespace vernier::probe
