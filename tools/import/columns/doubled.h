// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/import/columns/sheet_wishes.h"

namespace vernier::importer {

/// Columns of one axis: the target, a position with the heading of a measured value, a deviation.
struct DoubledReading {
  std::size_t target = 0, measured = 0, deviation = 0;
};

/// Decides which of the columns `measured` and `deviation` is the reading of the axis, and leaves out the
/// other one:
///   - the measured position is the target plus or minus the deviation: the deviation is computed from it;
///   - the measured position is equal to the target in each row, and the deviation is not 0: the control
///     shows this position, and the deviation is the reading.
/// Returns true if the deviation is the reading. Throws InputError if the two columns contradict each other.
bool settle_doubled(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                    std::vector<SheetColumn>& columns, const DoubledReading& doubled);

}  // namespace vernier::importer
