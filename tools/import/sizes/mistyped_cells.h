// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/import/sizes/sized_column.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Notes single cells of deviations that somebody probably typed wrong, and reads them as written:
/// - a lost minus sign: the value does not agree with the other readings, and the negative value does;
/// - another unit: 1000 times the value agrees with the other readings, and the cell has more decimals than
///   they have (0.0058 among 5.3), or the value itself does not agree.
/// The other readings are those of expected_readings().
void note_mistyped_cells(sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SizedColumn>& columns);

}  // namespace vernier::importer
