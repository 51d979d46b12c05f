// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>

#include "tools/format/csv_file.h"
#include "tools/format/units.h"

namespace vernier::part {

/// One column of a CSV file as numbers, in mm or deg. The CSV file must exist longer than the PartColumn.
class PartColumn {
 public:
  /// Throws InputError if the column is required but missing, or if its unit has another dimension.
  PartColumn(const format::CsvFile& csv, const std::string& name, format::Dimension dimension, bool required);
  bool present() const { return index_.has_value(); }
  /// Returns the number in a row. Throws InputError if the cell is not a number.
  double at(std::size_t row) const;

 private:
  const format::CsvFile& csv_;
  std::optional<std::size_t> index_;
  double factor_ = 1;
};

}  // namespace vernier::part
