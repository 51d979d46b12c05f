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
  /// with file, line and word. tool.
  TouchTable(const std::string& text, const std::string& file, const std::vector<std::string>& renames,
             const std::vector<std::string>& where);

  /// The rows that have this in that column (as the file calls it). Throws InputError.
  TouchTable only(const std::string& column, const std::string& value) const;
  /// What stands in a column, in the order of the file. Throws InputError: no such column.
  std::vector<std::string> values_of(const std::string& column) const;

  std::size_t rows() const { return csv_.rows.size(); }
  const std::string& file() const { return csv_.file; }
  std::size_t line(std::size_t row) const { return csv_.line[row]; }
  const format::CsvFile& csv() const { return csv_; }

  /// Numbers of the column known under one of the names, in base units (mm, deg, mm/min stays mm/min, s,
  /// degC); nothing where there is none. A cell that is no number is an InputError. The first name that a
  /// column has counts; of two columns that differ only by a suffix "_printed" the printed one, and a note
  /// says so.
  std::optional<Eigen::VectorXd> find(const std::vector<std::string>& names);
  /// The same, where it must be there: `what` says for what.
  Eigen::VectorXd need(const std::vector<std::string>& names, const std::string& what);
  /// Column u, mm; an InputError where one is not above 0.
  std::optional<Eigen::VectorXd> uncertainty();

  /// What was decided while reading.
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
