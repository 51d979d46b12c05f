// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/import/tables/column_map.h"

namespace vernier::importer {

/// Directions of the runs, if the order of the lines in the file does not give them.
enum class RunSenses { kAsListed, kAlternate, kForward };

/// Contents of a file of linear laser runs.
struct LaserFile {
  std::string axis, filetype, machine, date;
  std::size_t targets = 0, runs = 0, left_out = 0;  // runs of zeros only, which fill a unidirectional test
  ImportTable table;                                // X[mm], dirX, run, x[mm]
};

/// Reads a file of linear targets and runs (.rtl) of the common laser software: sections HEADER::, TARGET
/// DATA:: (targets in mm), USER-TEXT::, RUNS::, DEVIATIONS:: (run, target, deviation in um). axis: replaces
/// the axis of the file; empty: the axis of the file. Throws InputError with file, line and word: another
/// kind of file, a rotary axis, counts that do not agree, a target twice in a run, approach directions that
/// the file does not define.
LaserFile read_laser_file(const std::string& text, const std::string& file, const std::string& axis,
                          RunSenses senses);

}  // namespace vernier::importer
