// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/ballbar_file.h"
#include "tools/import/circular.h"

namespace vernier {

/// A result that the file prints beside the same one computed here, both in the printed unit.
struct PrintedResult {
  std::string place;  // "CCW", "ISO230_4 1996" …
  std::string name, unit;
  double printed = 0, computed = 0;
  bool equal = false;  // to the last digit that the file prints
};

/// All results of a file that this analysis computes too: those of the runs, of ISO 230-4 and of ANSI/ASME
/// B5.54. That they agree proves that the file's indices and angles are read as its software meant them.
/// tool.
std::vector<PrintedResult> printed_results(const BallbarFile& file, const CircularResult& circle);

}  // namespace vernier
