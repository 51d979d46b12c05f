// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/column_reader.h"

#include <limits>

#include "tools/text/numbers.h"

namespace vernier::model {

ColumnReader::ColumnReader(const format::CsvFile& csv) : csv_(csv) {
  for (std::size_t i = 0; i < csv.columns.size(); ++i) index_[csv.columns[i].name] = i;
}

void ColumnReader::require(const std::string& name, const std::string& why) const {
  if (!has(name)) throw text::InputError(header(), name, why);
}

Column ColumnReader::numbers(const std::string& name, format::Dimension dimension, bool filled) {
  const std::size_t column = index_.at(name);
  used_.insert(name);
  const format::Unit unit = *format::find_unit(csv_.columns[column].unit);
  if (unit.dimension != dimension)
    throw text::InputError(
        header(), csv_.columns[column].unit.empty() ? name : name + "[" + unit.name + "]",
        dimension == format::Dimension::kNone
            ? std::string("this column is a pure number and must not have a unit")
            : std::string("this column needs a unit, for example ") + format::base_unit(dimension));
  return read(column, unit.factor, unit.offset, filled);
}

Column ColumnReader::raw(const std::string& name) {
  used_.insert(name);
  return read(index_.at(name), 1, 0, false);
}

std::vector<std::string> ColumnReader::words(const std::string& name) {
  used_.insert(name);
  return peek(name);
}

std::vector<std::string> ColumnReader::peek(const std::string& name) const {
  std::vector<std::string> result;
  for (const auto& row : csv_.rows) result.push_back(row[index_.at(name)]);
  return result;
}

bool ColumnReader::is_text(const std::string& name) const {
  const std::size_t column = index_.at(name);
  std::size_t words = 0, filled = 0;
  for (const auto& row : csv_.rows) {
    if (row[column].empty()) continue;
    ++filled;
    if (!text::parse_number(row[column])) ++words;
  }
  return 2 * words > filled && csv_.columns[column].unit.empty();
}

format::Dimension ColumnReader::dimension(const std::string& name) const {
  return format::find_unit(unit(name))->dimension;
}

std::vector<format::CsvColumn> ColumnReader::unused() const {
  std::vector<format::CsvColumn> list;
  for (const format::CsvColumn& column : csv_.columns)
    if (!used_.contains(column.name)) list.push_back(column);
  return list;
}

Column ColumnReader::read(std::size_t column, double factor, double offset, bool filled) const {
  Column result(static_cast<Eigen::Index>(rows()));
  for (std::size_t row = 0; row < rows(); ++row) {
    const std::string& text = csv_.rows[row][column];
    double& value = result[static_cast<Eigen::Index>(row)];
    if (text.empty()) {
      if (filled)
        throw text::InputError(place(row), csv_.columns[column].name, "this column may not be empty");
      value = std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    const auto number = text::parse_number(text);
    if (!number)
      throw text::InputError(place(row), text, "not a number, in column " + csv_.columns[column].name);
    value = factor * *number + offset;
  }
  return result;
}

}  // namespace vernier::model
