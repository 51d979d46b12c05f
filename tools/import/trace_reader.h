// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/import/ballbar_file.h"

namespace vernier {

/// What a file of Ballbar Trace does not hold and the operator must say.
struct TraceSetup {
  std::string axis_a = "X", axis_b = "Y";
  double length_mm = 100;
  double radius_mm = 100;  // of the programmed circle
  double feed_mm_min = 0;  // actual; the speed is taken as constant
  double start_deg = 180;  // angle of the first reading, from +A towards +B
  double sample_rate_hz = 200;
  int direction_of_zero = +1;  // sense of "Direction": 0
};

/// Reads a file of Renishaw Ballbar Trace (JSON: Runs[].Direction 0 or 1, Runs[].Readings, ErrorUnits). All
/// readings lie in the arc, none is overshoot. Throws InputError with file, line and word. tool.
BallbarFile read_ballbar_trace(const std::string& path, const TraceSetup& setup);

}  // namespace vernier
