// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"

namespace vernier::importer {

struct BallbarCsvOptions {
  /// Time between the last sample of a run and the first sample of the next run, s. The assumed time between
  /// two runs is used because the instrument does not record it. The default time is the dwell (5 s) plus the
  /// feed-in and feed-out motions between two runs of the usual test program.
  double pause_s = 9.0;
};

struct BallbarCsv {
  std::string text;
  std::size_t rows = 0, fit_rows = 0, check_rows = 0;
  std::vector<std::string> run_labels;
};

/// Writes ball-bar files as one measurement file (CSV). The columns of the file are positions, motion, clock,
/// the length with its centre, run and role. Samples from `start` to `end` of a run have the role `fit`.
/// Samples before and after the arc `start`..`end` of a run have the role `check`. An axis has a
/// column if the plane of at least one file contains the axis.
BallbarCsv ballbar_csv(const std::vector<BallbarFile>& files, const BallbarCsvOptions& options);

}  // namespace vernier::importer
