// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "tools/model/measurement.h"
#include "tools/timebase/closure.h"
#include "tools/timebase/repeats.h"
#include "tools/timebase/run_match.h"

namespace vernier::timebase {

/// A stretch of a run beside its repetition in the same run. Rows are those of the measurement.
struct TimeBlock {
  std::size_t run = 0;  // index into States::run_names
  std::size_t first_row = 0, last_row = 0;
  double best_lag = 0, implied_lag = 0;  // rows of the run
  double correlation = 0, implied_correlation = 0;
  double difference_um = 0, implied_difference_um = 0;  // rms, mean and slope of the block taken off
  double p_value = 1;
};

/// Samples missing from the record (or waited for in the pass that is longer: a repetition cannot tell
/// which).
struct TimeGap {
  std::size_t run = 0, row = 0;         // before this row of the measurement
  double row_uncertainty = 0;           // rows
  double missing = 0, uncertainty = 0;  // samples
};

/// Two runs over the same path whose residuals agree elsewhere than the positions say.
struct TimeRunMatch {
  std::size_t first_run = 0, second_run = 0;
  RunMatch match;
};

/// A run over a closed path whose end repeats its beginning.
struct TimeClosure {
  std::size_t run = 0;
  Closure closure;
};

/// Do positions and readings of a measurement belong to the same instants?
struct TimeBaseFinding {
  bool found = false;
  std::vector<TimeBlock> blocks;      // all that could be compared
  std::vector<TimeGap> gaps;          // only where found
  std::vector<TimeRunMatch> matches;  // all pairs that could be compared
  std::vector<TimeClosure> closures;  // all runs over a closed path
  double p_value = 1;                 // of the strongest evidence, after the number of looks
  std::string why;                    // a sentence or two for people
};

struct TimeBaseOptions {
  double significance = 1e-3;
  /// Check rows are looked at too: nothing is fitted or chosen by them, a clock is the whole record's.
  bool with_check_rows = true;
  std::size_t most_pairs = 12;  // of runs that are compared
};

/// Compares what repeats: within a run the residual of a later pass over the same poses with that of the
/// earlier one, block by block, over the lag in rows; between runs over the same path the residuals along it;
/// of a closed path its end with its beginning. Found if they agree, significantly better than chance and
/// than where the positions say, at another lag in two neighbouring blocks at least, or row by row between
/// runs whose positions say another rate, or before the path closes; the chances of the last two are joined
/// (the last proves nothing alone). A residual that is zero, white, smooth, periodic or that truly repeats
/// (hysteresis, cyclic errors, drift) is none. Poses that come only once, or a second pass at another speed,
/// say nothing. `residual`: measured - model per observation, mm; lengths only, rotations are not looked at.
/// tool.
TimeBaseFinding examine_time_base(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                                  const TimeBaseOptions& options = {});

}  // namespace vernier::timebase
