// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include "tools/import/sizes/sized_column.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// Largest deviations that the user calls plausible for this machine (--deviation 20mm); without a value, the
/// limits of the source apply.
struct PlausibleDeviation {
  std::optional<double> mm, deg;
};

/// Compares the size of each column of length deviations with its unit: with the travel of its axis, with the
/// other rows and with the other columns of deviations. Returns at most one doubt for each column whose unit
/// the user did not state; an unusual size is noted in `sheet`. Limits: `plausible`, and the constants in the
/// source, with their reasons.
std::vector<SizeDoubt> judge_deviation_sizes(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                             const std::vector<SizedColumn>& columns,
                                             const PlausibleDeviation& plausible = {});

/// Notes the columns whose unit is a decimal part of a millimetre or an inch: divisions of a dial gauge.
void note_decimal_parts(sheet::Sheet& sheet, const sheet::SheetTable& table,
                        const std::vector<SizedColumn>& columns);

}  // namespace vernier::importer
