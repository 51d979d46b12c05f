// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/columns/column_map.h"
#include "tools/import/logs/pairing.h"
#include "tools/model/machine.h"

namespace vernier::importer {

struct LogOptions {
  double dwell_s = 0.5;     // shortest dwell, s; shorter standstills are ignored
  double still = 0.01;      // mm or deg; an axis whose position changes by less than this value is at rest
  double tolerance_mm = 2;  // permitted difference of a distance between two points, machine against nominal
                            // machine
};

/// Table of a laser tracker combined with the log of a machine.
struct LoggedTable {
  ImportTable table;  // the tracker points with a dwell, and the values of the log at this dwell
  Pairing pairing;
  std::vector<Dwell> dwells;
  std::vector<std::size_t> unmatched_line;  // lines of the tracker points without a dwell
};

/// Assigns the axis positions and inputs of a machine's log to the points of a laser tracker (x y z, and t if
/// the clock of the tracker is known). The assigned values are those of the dwell in which the point was
/// measured: the mean of numbers, the first word of a label column, and `t` by the clock of the log. `text`:
/// the log as CSV with columns of the measurement format. The log must contain `t` and every axis of the
/// machine, in time order. If the log of the machine is not valid, throws InputError with file,
/// line and word.
LoggedTable with_log(const ImportTable& tracker, const std::string& text, const std::string& log_file,
                     const model::Machine& machine, const LogOptions& options);

}  // namespace vernier::importer
