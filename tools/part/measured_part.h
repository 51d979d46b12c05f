// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/part/defect.h"

namespace vernier::part {

/// One measured point of the part.
struct MeasuredPoint {
  PartPoint at;
  double defect_mm = 0;       // along the outward normal, positive: material left
  double uncertainty_mm = 0;  // standard uncertainty; 0 where not given
  std::size_t line = 0;       // in the file
};

struct MeasuredPart {
  std::string file;
  std::vector<MeasuredPoint> points;
};

/// Reads `sx[mm],sy[mm],sz[mm]` (nominal surface point, workpiece coordinates), `defect[mm]` and, if present,
/// `u[mm]`; other columns are ignored. Each point is assigned to the nearest flank. Throws InputError with
/// file, line and word: a missing column, not a number, a point farther than 0.05 mm from both flanks, u not
/// positive or given for some rows only.
MeasuredPart read_measured_part(const std::string& text, const std::string& file);

}  // namespace vernier::part
