// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/import/sizes/sized_column.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// A value that is far from the values before and behind it.
struct OutlyingValue {
  std::size_t index = 0;       // in the list of values
  double least = 0, most = 0;  // of the values before and behind it
  double times = 0;  // factor 10, 100 or 1000 of a lost decimal sign, or 1/1000 of another unit: the value
                     // divided by it agrees with the other ones; 0: no factor explains the value
};

/// Returns the values that are far outside the range of the two values before and the two values behind them.
/// `values`: in their order, finite. The scale is the median step from value to value, so that values in no
/// order have no outliers. Limits: the constants in the source, with their reasons.
std::vector<OutlyingValue> outlying_values(const std::vector<double>& values);

/// Notes cells of readings that are far from the cells before and behind them: an outlier is data and is
/// read, but a decimal sign may be lost.
void note_outlying_cells(sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SizedColumn>& columns);

/// Tests whether a column of deviations has two units: cells with more decimals that are smaller by a factor
/// of 1000 than the other cells (11,7 um beside 0,0117 mm). Returns at most one doubt for each column; for a
/// column that the user stated in an option, a note in `sheet`.
std::vector<SizeDoubt> judge_mixed_units(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                         const std::vector<SizedColumn>& columns);

}  // namespace vernier::importer
