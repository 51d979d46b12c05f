// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"

namespace vernier::importer {

/// Data of a circular test that a file of Ballbar Trace does not contain, so that the operator must state
/// them.
struct TraceSetup {
  std::string axis_a = "X", axis_b = "Y";
  double length_mm = 100;
  double radius_mm = 100;  // radius of the programmed circle
  double feed_mm_min = 0;  // actual feed; the speed is assumed to be constant
  double start_deg = 180;  // angle of the first reading, from +A towards +B
  double sample_rate_hz = 200;
  int direction_of_zero = +1;  // direction of a run with "Direction": 0
};

/// One circle of a test with several circles: its plane ("YZ": first axis Y) and the angle of its first
/// reading.
struct TraceCircle {
  std::string plane;
  double start_deg = 180;
};

/// Reads the files of a test whose path has several circles about one centre (XY, YZ, ZX), one after another.
/// The result of read_trace_circles() has one BallbarFile per circle. The runs of all files are assigned to
/// the circles; both keep their order. Each circle has the same number of runs (two if both directions of a
/// circle follow each other). The label of each run is the plane of its circle, for example "YZ".
/// If there is only one circle, each file gives one BallbarFile with all runs of the file. Throws
/// InputError if the number of runs is not a multiple of the number of circles, and for all errors
/// of read_ballbar_trace.
std::vector<BallbarFile> read_trace_circles(const std::vector<std::string>& paths, const TraceSetup& setup,
                                            const std::vector<TraceCircle>& circles);

/// Reads a file of Renishaw Ballbar Trace (JSON with Runs[].Direction 0 or 1, Runs[].Readings, ErrorUnits).
/// All readings of a Trace file belong to the analysed arc; there are no overshoot arcs. If the file is not
/// valid, throws InputError with file, line and word.
BallbarFile read_ballbar_trace(const std::string& path, const TraceSetup& setup);

}  // namespace vernier::importer
