// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tools/format/csv_file.h"
#include "tools/format/units.h"
#include "tools/model/states.h"

namespace vernier::model {

/// The columns of one measurement file as numbers in their base units. An empty cell has the value NaN. Every
/// reader of measurement files uses this class for its numbers. A ColumnReader keeps a reference to the CSV
/// file. A column whose name is requested must be in the file, except for has().
class ColumnReader {
 public:
  explicit ColumnReader(const format::CsvFile& csv);

  bool has(const std::string& name) const { return index_.contains(name); }
  /// Throws InputError with the message `why` if the file does not have the column `name`.
  void require(const std::string& name, const std::string& why) const;

  /// Returns a column of numbers. The unit of the column must have the dimension `dimension`. `filled`: true
  /// if an empty cell is an error. For a cell that is not a valid number, throws InputError with
  /// file, line and word.
  Column numbers(const std::string& name, format::Dimension dimension, bool filled);
  /// Returns a column as it is in the file, without conversion of units.
  Column raw(const std::string& name);
  std::vector<std::string> words(const std::string& name);
  /// Returns a column that belongs to another reading, without conversion of units. peek() does not mark the
  /// column as read.
  std::vector<std::string> peek(const std::string& name) const;

  /// True if most of the filled cells of a column contain words. If only a few cells contain words, these
  /// words are errors in a column of numbers.
  bool is_text(const std::string& name) const;
  format::Dimension dimension(const std::string& name) const;
  const std::string& unit(const std::string& name) const { return column(name).unit; }
  const format::CsvColumn& column(const std::string& name) const { return csv_.columns[index_.at(name)]; }
  const std::string& cell(const std::string& name, std::size_t row) const {
    return csv_.rows[row][index_.at(name)];
  }
  std::size_t rows() const { return csv_.rows.size(); }

  /// Returns the columns of the file that no function has read yet.
  std::vector<format::CsvColumn> unused() const;

  text::Place header() const { return {csv_.file, csv_.header_line}; }
  text::Place place(std::size_t row) const { return {csv_.file, csv_.line[row]}; }

 private:
  Column read(std::size_t column, double factor, double offset, bool filled) const;

  const format::CsvFile& csv_;
  std::map<std::string, std::size_t> index_;
  std::set<std::string> used_;
};

}  // namespace vernier::model
