// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/part/defect.h"

namespace vernier::part {

/// One measured point of the test part.
struct MeasuredPoint {
  PartPoint at;
  double defect_mm = 0;       // defect along the outward normal; positive: material remains
  double uncertainty_mm = 0;  // standard uncertainty; 0 if it is not given
  std::size_t line = 0;       // line in the file
};

struct MeasuredPart {
  std::string file;
  std::vector<MeasuredPoint> points;
};

/// Reads a file with the columns `sx[mm],sy[mm],sz[mm]` (nominal surface point, workpiece coordinates),
/// `defect[mm]` and optionally `u[mm]`. Other columns are ignored. Each point is assigned to the nearest
/// flank. Throws InputError with file, line and word for: a missing column, a cell that is not a number, a
/// point farther than 0.05 mm from both flanks, a u that is not positive or is given only in some rows.
MeasuredPart read_measured_part(const std::string& text, const std::string& file);

}  // namespace vernier::part
