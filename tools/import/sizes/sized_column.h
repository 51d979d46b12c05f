// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/format/units.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// What the judges of sizes need to know about one column of a sheet.
struct SizedColumn {
  enum class Use { kPosition, kDeviation, kOther };
  Use use = Use::kOther;
  std::string name, unit;  // of the measurement file; for a deviation, the name of its axis
  std::string positions;   // for a deviation: name of the column with the positions that it belongs to
  bool stated = false;     // true: the user stated the unit in an option, or a profile states it
  bool profile = false;    // true: a profile of earlier files states the unit
  std::string measures;    // for a measured position: name of its axis, otherwise empty
  bool axis = false;       // true: the column has the positions of an axis of the machine
};

/// A size that only a wrong unit or a wrong cell explains.
struct SizeDoubt {
  std::size_t column = 0, line = 0;
  std::string word;  // the cell; empty: the heading of the column
  std::string text;  // what contradicts the unit, and what to do
};

/// Returns the unit of a column of lengths or angles; nullopt for other columns.
std::optional<format::Unit> sized_unit(const SizedColumn& column);

/// The readings of one column as deviations in mm or deg, with the rows of the sheet.
struct DeviationSeries {
  std::vector<double> value;
  std::vector<std::size_t> row;
};

/// Returns the deviations of column `k`: its values, or its measured positions without the positions of their
/// axis. Rows without a number are left out. Empty: the column has no readings.
DeviationSeries deviations_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                              const std::vector<SizedColumn>& columns, std::size_t k);

/// Returns a size with a unit that suits it. `size`: in mm, or in deg if `angle` is true.
std::string size_text(double size, bool angle = false);

}  // namespace vernier::importer
