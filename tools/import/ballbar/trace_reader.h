// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"

namespace vernier::importer {

/// Data that a file of Ballbar Trace does not contain and the operator must give.
struct TraceSetup {
  std::string axis_a = "X", axis_b = "Y";
  double length_mm = 100;
  double radius_mm = 100;  // of the programmed circle
  double feed_mm_min = 0;  // actual; the speed is taken as constant
  double start_deg = 180;  // angle of the first reading, from +A towards +B
  double sample_rate_hz = 200;
  int direction_of_zero = +1;  // direction of "Direction": 0
};

/// A circle of a path: its plane, first axis first ("YZ"), and the angle of its first reading.
struct TraceCircle {
  std::string plane;
  double start_deg = 180;
};

/// Reads the files of a test whose path has several circles about one centre (XY, YZ, ZX), one after another:
/// returns one BallbarFile per circle. The runs of all files, in their order, are assigned to the circles in
/// their order. Each circle gets the same number of runs (two if both directions of a circle follow each
/// other); the plane is the label of the runs. With one circle each file gives one BallbarFile with all its
/// runs. Throws InputError if the runs do not divide evenly, and as read_ballbar_trace.
std::vector<BallbarFile> read_trace_circles(const std::vector<std::string>& paths, const TraceSetup& setup,
                                            const std::vector<TraceCircle>& circles);

/// Reads a file of Renishaw Ballbar Trace (JSON: Runs[].Direction 0 or 1, Runs[].Readings, ErrorUnits). All
/// readings of the file are in the arc; no reading is overshoot. Throws InputError with file, line and word.
BallbarFile read_ballbar_trace(const std::string& path, const TraceSetup& setup);

}  // namespace vernier::importer
