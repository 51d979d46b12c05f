// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Returns the columns whose headings name positions of an axis.
std::vector<std::size_t> position_columns(const sheet::SheetTable& table);

/// True if the row has a number in one of these columns.
bool has_number(const sheet::Sheet& sheet, std::size_t row, const std::vector<std::size_t>& columns);

/// True if each number of the row is a statistic of the numbers above it in its column, to the last digit:
/// the mean, the standard deviation (n - 1 or n), a multiple of it, the largest, smallest or median value,
/// the range, the sum, the rms or the count. The numbers above are those since the row `since`, or, with
/// `all_rows`, also those of all rows.
bool agrees_with_statistics(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t row,
                            std::size_t since, bool all_rows);

}  // namespace vernier::importer
