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

/// A block of a run, and its repetition in the same run. The row numbers of a TimeBlock are those of the
/// measurement.
struct TimeBlock {
  std::size_t run = 0;  // index into States::run_names
  std::size_t first_row = 0, last_row = 0;
  double best_lag = 0, implied_lag = 0;  // in rows of the run
  double correlation = 0, implied_correlation = 0;
  double difference_um = 0, implied_difference_um = 0;  // rms difference, after removal of mean and slope of
                                                        // the block
  double p_value = 1;
};

/// A gap: samples that are missing in the record. The missing samples of a gap may also be additional samples
/// in the longer pass, because a repetition cannot distinguish both cases.
struct TimeGap {
  std::size_t run = 0, row = 0;         // the gap is before this row of the measurement
  double row_uncertainty = 0;           // in rows
  double missing = 0, uncertainty = 0;  // number of missing samples, and its standard uncertainty
};

/// Two runs over the same path whose residuals agree at another relation of the rows than their positions.
struct TimeRunMatch {
  std::size_t first_run = 0, second_run = 0;
  RunMatch match;
};

/// A run over a closed path whose end repeats its start.
struct TimeClosure {
  std::size_t run = 0;
  Closure closure;
};

/// Result of the test whether the positions and the readings of a measurement belong to the same times (time
/// base error).
struct TimeBaseFinding {
  bool found = false;
  std::vector<TimeBlock> blocks;      // all blocks that could be compared
  std::vector<TimeGap> gaps;          // gaps; only if a time base error was found
  std::vector<TimeRunMatch> matches;  // all pairs of runs that could be compared
  std::vector<TimeClosure> closures;  // all runs over a closed path
  double p_value = 1;                 // p-value of the strongest evidence, corrected for the number of tests
  std::string why;                    // one or two sentences for people
};

struct TimeBaseOptions {
  double significance = 1e-3;
  /// True if check rows are included in the test. Check rows can be included because the test fits and
  /// selects nothing, and because the clock belongs to the whole record.
  bool with_check_rows = true;
  std::size_t most_pairs = 12;  // largest number of compared pairs of runs
};

/// Tests the time base of a measurement by comparing repetitions of the same poses. First comparison, within
/// a run: the residual of a later pass over the same poses with that of the earlier pass, block by block, at
/// different lags in rows. Second comparison, between runs over the same path: their residuals along the
/// path. Third comparison, for closed paths: the end of the path with its start. A time base error is found
/// if the residuals of two passes agree best at another shift in rows than the positions of the passes. The
/// agreement of the residuals must be significantly better than by chance, and better than at the lag of the
/// positions. One of three conditions must also be met: the agreement occurs in at least two neighbouring
/// blocks; or row by row between runs whose positions have another rate; or before the path closes. The
/// probabilities of the last two cases are combined, because the last case alone is no proof. A residual
/// gives no finding if it is zero, white, smooth or periodic, or if it really repeats (hysteresis, cyclic
/// errors, drift). Poses that occur only once, and a second pass at another speed, give no information about
/// the time base. `residual`: measured - model, one value per observation, mm. Only lengths are tested;
/// rotations are not tested.
TimeBaseFinding examine_time_base(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                                  const TimeBaseOptions& options = {});

}  // namespace vernier::timebase
