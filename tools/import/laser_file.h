// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/import/column_map.h"

namespace vernier::importer {

/// In which senses the runs went, where the order of their lines does not say it.
enum class RunSenses { kAsListed, kAlternate, kForward };

/// What a file of linear laser runs says.
struct LaserFile {
  std::string axis, filetype, machine, date;
  std::size_t targets = 0, runs = 0, left_out = 0;  // runs of nothing but zeros that fill a test of one sense
  ImportTable table;                                // X[mm], dirX, run, x[mm]
};

/// Reads a file of linear targets and runs (.rtl) as the common laser software writes it: sections HEADER::,
/// TARGET DATA:: (targets in mm), USER-TEXT::, RUNS::, DEVIATIONS:: (run, target, deviation in um). axis:
/// over the file's own; empty: its own. Throws InputError with file, line and word: another kind of file, an
/// axis that turns, counts that do not agree, a target twice in a run, senses that nothing says. tool.
LaserFile read_laser_file(const std::string& text, const std::string& file, const std::string& axis,
                          RunSenses senses);

}  // namespace vernier::importer
