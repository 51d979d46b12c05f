// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/tables/column_map.h"
#include "tools/import/tables/pairing.h"
#include "tools/model/machine.h"

namespace vernier::importer {

struct LogOptions {
  double dwell_s = 0.5;     // shorter standstills are ignored
  double still = 0.01;      // mm or deg: an axis that stays within it is at rest
  double tolerance_mm = 2;  // ways of machine and nominal machine between two points
};

/// Result of combining a tracker's table with a machine's log.
struct LoggedTable {
  ImportTable table;  // the points that were paired, with the log's columns at their dwell
  Pairing pairing;
  std::vector<Dwell> dwells;
  std::vector<std::size_t> unmatched_line;  // of points in the tracker's file
};

/// Assigns to the points of a tracker's table (x y z, and t if its clock is known) the axis positions and
/// inputs of a machine's log. The assigned values are those of the dwell in which the point was measured:
/// means of numbers, the first of words, `t` by the clock of the log. text: the log, a CSV of measurement
/// columns with `t` and every axis of the machine, in time order. Throws InputError with file, line and word.
LoggedTable with_log(const ImportTable& tracker, const std::string& text, const std::string& log_file,
                     const model::Machine& machine, const LogOptions& options);

}  // namespace vernier::importer
