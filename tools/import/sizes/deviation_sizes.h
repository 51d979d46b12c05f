// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// What the judge of sizes needs to know about one column of a sheet.
struct SizedColumn {
  enum class Use { kPosition, kDeviation, kOther };
  Use use = Use::kOther;
  std::string name, unit;  // of the measurement file; for a deviation, the name of its axis
  std::string positions;   // for a deviation: name of the column with the positions that it belongs to
  bool stated = false;     // true: the user stated the unit in an option
};

/// A size that only a wrong unit explains.
struct SizeDoubt {
  std::size_t column = 0, line = 0;
  std::string text;  // what contradicts the unit, and what to do
};

/// Compares the size of each column of length deviations with its unit: with the travel of its axis, with the
/// other rows and with the other columns of deviations. Returns at most one doubt for each column whose unit
/// the user did not state; an unusual size is noted in `sheet`. Limits: the constants in the source, with
/// their reasons.
std::vector<SizeDoubt> judge_deviation_sizes(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                             const std::vector<SizedColumn>& columns);

/// Notes the columns whose unit is a decimal part of a millimetre or an inch: divisions of a dial gauge.
void note_decimal_parts(sheet::Sheet& sheet, const sheet::SheetTable& table,
                        const std::vector<SizedColumn>& columns);

}  // namespace vernier::importer
