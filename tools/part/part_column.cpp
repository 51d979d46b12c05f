// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/part_column.h"

#include "tools/text/numbers.h"

namespace vernier::part {

PartColumn::PartColumn(const format::CsvFile& csv, const std::string& name, format::Dimension dimension,
                       bool required)
    : csv_(csv) {
  for (std::size_t i = 0; i < csv.columns.size(); ++i)
    if (csv.columns[i].name == name) index_ = i;
  const text::Place header{csv.file, csv.header_line};
  if (!index_ && required) throw text::InputError(header, name, "a required column is missing");
  if (!index_) return;
  const std::optional<format::Unit> unit = format::find_unit(csv.columns[*index_].unit);
  if (!unit || unit->dimension != dimension)
    throw text::InputError(header, name,
                           "needs a unit such as " + name + "[" + format::base_unit(dimension) + "]");
  factor_ = unit->factor;
}

double PartColumn::at(std::size_t row) const {
  const std::string& text = csv_.rows[row][*index_];
  const std::optional<double> number = text::parse_number(text);
  if (!number)
    throw text::InputError({csv_.file, csv_.line[row]}, text,
                           "no number in column " + csv_.columns[*index_].name);
  return *number * factor_;
}

}  // namespace vernier::part
