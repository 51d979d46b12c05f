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

/// The columns of one measurement file as numbers in their base units. NaN: an empty cell. Every reader of
/// measurement files uses this class for its numbers. ColumnReader keeps a reference to the file. Except for
/// has(), the requested names must be in the file.
class ColumnReader {
 public:
  explicit ColumnReader(const format::CsvFile& csv);

  bool has(const std::string& name) const { return index_.contains(name); }
  /// Throws InputError if the file does not have the column. `why` is the message.
  void require(const std::string& name, const std::string& why) const;

  /// Returns a column that must have this dimension. `filled`: an empty cell is an error. Throws
  /// InputError with file, line and word.
  Column numbers(const std::string& name, format::Dimension dimension, bool filled);
  /// Returns a column without conversion, as the file has it.
  Column raw(const std::string& name);
  std::vector<std::string> words(const std::string& name);
  /// Returns a column that belongs to another reading, without conversion. The column is not marked as read.
  std::vector<std::string> peek(const std::string& name) const;

  /// True if a column contains words in most of its filled cells. Fewer words are errors in a column of
  /// numbers.
  bool is_text(const std::string& name) const;
  format::Dimension dimension(const std::string& name) const;
  const std::string& unit(const std::string& name) const { return column(name).unit; }
  const format::CsvColumn& column(const std::string& name) const { return csv_.columns[index_.at(name)]; }
  const std::string& cell(const std::string& name, std::size_t row) const {
    return csv_.rows[row][index_.at(name)];
  }
  std::size_t rows() const { return csv_.rows.size(); }

  /// Returns the columns that are not yet read.
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
