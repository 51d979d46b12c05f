// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/import/ballbar_file.h"
#include "tools/import/circular.h"

namespace vernier {

/// Where the machine was commanded to be when one reading was taken, on a circle run at constant speed.
struct CirclePoint {
  double angle_deg = 0;              // from +A towards +B, 0..360
  double position_mm[2] = {0, 0};    // along A and B, about the programmed centre
  double velocity_mm_s[2] = {0, 0};  // the same order
  double acceleration_mm_s2[2] = {0, 0};
  int direction[2] = {0, 0};    // sense of the last motion, -1 or +1
  double since_mm[2] = {0, 0};  // travel of the axis since its last reversal
};

/// Actual feed of a run, from the samples that it took for its arc: mm/min. tool.
double actual_feed_mm_min(const BallbarFile& file, const BallbarRun& run);

/// Commanded motion at sample `index` of a run; beyond start..end the angle goes on at the same speed. tool.
CirclePoint circle_point(const BallbarFile& file, const BallbarRun& run, std::size_t index);

/// The analysed arcs (start..end) of all runs for analyse_circle. tool.
std::vector<CircularPass> circular_passes(const BallbarFile& file);

struct BallbarCsvOptions {
  /// Time between the records of two runs, s, where the instrument does not log it. The default is what the
  /// dwell (5 s) and the feeds in and out between the runs of the usual program take.
  double pause_s = 9.0;
};

struct BallbarCsv {
  std::string text;
  std::size_t rows = 0, fit_rows = 0, check_rows = 0;
  std::vector<std::string> run_labels;
};

/// Measurement file (CSV) of some ball-bar files: positions, motion, clock, length with its centre, run and
/// role. Samples in start..end are `fit`, those before and after it `check`. An axis is a column if some
/// file's plane has it. tool.
BallbarCsv ballbar_csv(const std::vector<BallbarFile>& files, const BallbarCsvOptions& options);

}  // namespace vernier
