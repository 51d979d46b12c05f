// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>

#include "tools/format/csv_file.h"
#include "tools/format/units.h"

namespace vernier::part {

/// One column of a file, in mm or deg. The file must outlive the PartColumn.
class PartColumn {
 public:
  /// Throws InputError if the column is required and missing, or has a unit of another dimension.
  PartColumn(const format::CsvFile& csv, const std::string& name, format::Dimension dimension, bool required);
  bool present() const { return index_.has_value(); }
  /// Throws InputError if the cell is not a number.
  double at(std::size_t row) const;

 private:
  const format::CsvFile& csv_;
  std::optional<std::size_t> index_;
  double factor_ = 1;
};

}  // namespace vernier::part
