// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "tools/format/csv_file.h"

namespace vernier::probe {

/// Touches as a table: columns by name, `feed[mm/min]` or `feed_mm_min`, lengths in any unit.
class TouchTable {
 public:
  /// renames: "column=name" or "column=name[unit]"; where: "column=value" rows to keep. Throws InputError
  /// with file, line and word.
  TouchTable(const std::string& text, const std::string& file, const std::vector<std::string>& renames,
             const std::vector<std::string>& where);

  /// Returns the rows with this value in this column (named as in the file). Throws InputError.
  TouchTable only(const std::string& column, const std::string& value) const;
  /// Returns the values of a column, in the order of the file. Throws InputError if the column does not
  /// exist.
  std::vector<std::string> values_of(const std::string& column) const;

  std::size_t rows() const { return csv_.rows.size(); }
  const std::string& file() const { return csv_.file; }
  std::size_t line(std::size_t row) const { return csv_.line[row]; }
  const format::CsvFile& csv() const { return csv_; }

  /// Returns the numbers of the column with one of the names, in base units (mm, deg, mm/min stays mm/min, s,
  /// degC); nullopt if there is no such column. A cell that is not a number is an InputError. The first name
  /// with a column is used. Of two columns that differ only by a suffix "_printed", the printed column is
  /// used, and a note reports this.
  std::optional<Eigen::VectorXd> find(const std::vector<std::string>& names);
  /// Returns the numbers of a required column; throws InputError if the column is missing. `what`: purpose of
  /// the column.
  Eigen::VectorXd need(const std::vector<std::string>& names, const std::string& what);
  /// Returns column u, mm. A value that is not above 0 is an InputError.
  std::optional<Eigen::VectorXd> uncertainty();

  /// Decisions made during reading.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Column {
    std::string name, unit;  // without the unit in the name
    bool printed = false;
    std::size_t index = 0;
  };
  std::vector<Column> columns_;
  format::CsvFile csv_;
  std::vector<std::string> notes_;
};

}  // namespace vernier::probe
