// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/import/ballbar/ballbar_file.h"

namespace vernier::importer {

struct BallbarCsvOptions {
  /// Time between the records of two runs, s, if the instrument does not record it. The default is the time
  /// of the dwell (5 s) and of the feeds in and out between the runs of the usual program.
  double pause_s = 9.0;
};

struct BallbarCsv {
  std::string text;
  std::size_t rows = 0, fit_rows = 0, check_rows = 0;
  std::vector<std::string> run_labels;
};

/// Writes ball-bar files as one measurement file (CSV): positions, motion, clock, length with its centre, run
/// and role. Samples in start..end have the role `fit`, samples before and after it the role `check`. An axis
/// becomes a column if the plane of a file contains the axis.
BallbarCsv ballbar_csv(const std::vector<BallbarFile>& files, const BallbarCsvOptions& options);

}  // namespace vernier::importer
