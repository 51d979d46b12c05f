// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <vector>

#include "tools/import/sizes/sized_column.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// A target that is not between the targets beside it, although a multiple of it is.
struct MisplacedTarget {
  std::size_t index = 0;  // in the list of values
  double times = 0;       // this multiple of the value continues the order: 0.1 for 1505 in place of 150.5
  double before = 0, behind = 0;  // the targets beside it
};

/// Returns the targets that are out of order, while 1/10, 1/100, 1/1000, 10 times or 1000 times the value is
/// in order. `values`: in the order of the rows, finite. Columns of positions without an order (a grid,
/// random positions) have none. A value that occurs a second time is a return to this target.
std::vector<MisplacedTarget> misplaced_targets(const std::vector<double>& values);

/// Tests the positions of each axis for typing errors: a target out of order whose decimal sign is lost, and
/// cells in m below a heading in mm. Returns at most one doubt for each column; for a column that the user
/// stated in an option, a note in `sheet`.
std::vector<SizeDoubt> judge_targets(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                     const std::vector<SizedColumn>& columns);

/// Tests each column of deviations for lost decimal signs: many cells without a decimal sign among cells with
/// one, and the column is much smoother with the signs. Returns at most one doubt for each column; for a
/// column that the user stated in an option, a note in `sheet`.
std::vector<SizeDoubt> judge_lost_signs(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                        const std::vector<SizedColumn>& columns);

/// Notes runs whose deviations are 10 or 100 times those of the other runs at the same targets.
void note_other_scales(sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<SizedColumn>& columns);

}  // namespace vernier::importer
