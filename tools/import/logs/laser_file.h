// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/import/columns/column_map.h"

namespace vernier::importer {

/// Approach directions of the runs. The approach directions are necessary if the order of the lines in the
/// file does not give the directions.
enum class RunSenses { kAsListed, kAlternate, kForward };

/// Content of a file with linear laser interferometer runs.
struct LaserFile {
  std::string axis, filetype, machine, date;
  std::size_t targets = 0, runs = 0, left_out = 0;  // left_out: number of runs that contain only zeros,
                                                    // because the test was unidirectional
  ImportTable table;                                // columns X[mm], dirX, run, x[mm]
};

/// Reads a file with linear targets and runs (.rtl) of the usual laser software. The sections of the file are
/// HEADER::, TARGET DATA:: (targets in mm), USER-TEXT::, RUNS::, DEVIATIONS:: (run, target, deviation in um).
/// `axis`: name of the axis that replaces the name in the file; empty: the name in the file is used. Throws
/// InputError with file, line and word for: another kind of file, a rotary axis, counts that do not agree, a
/// target that occurs twice in a run, approach directions that the file does not define.
LaserFile read_laser_file(const std::string& text, const std::string& file, const std::string& axis,
                          RunSenses senses);

}  // namespace vernier::importer
