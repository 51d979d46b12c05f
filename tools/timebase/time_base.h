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

/// A block of a run and its repetition in the same run. Row numbers are those of the measurement.
struct TimeBlock {
  std::size_t run = 0;  // index into States::run_names
  std::size_t first_row = 0, last_row = 0;
  double best_lag = 0, implied_lag = 0;  // rows of the run
  double correlation = 0, implied_correlation = 0;
  double difference_um = 0, implied_difference_um = 0;  // rms, without mean and slope of the block
  double p_value = 1;
};

/// Samples missing from the record (or additional samples in the longer pass: a repetition cannot
/// distinguish the two).
struct TimeGap {
  std::size_t run = 0, row = 0;         // before this row of the measurement
  double row_uncertainty = 0;           // rows
  double missing = 0, uncertainty = 0;  // samples
};

/// Two runs over the same path whose residuals agree at another map than their positions.
struct TimeRunMatch {
  std::size_t first_run = 0, second_run = 0;
  RunMatch match;
};

/// A run over a closed path whose end repeats its start.
struct TimeClosure {
  std::size_t run = 0;
  Closure closure;
};

/// Result of the test whether positions and readings of a measurement belong to the same times.
struct TimeBaseFinding {
  bool found = false;
  std::vector<TimeBlock> blocks;      // all blocks that could be compared
  std::vector<TimeGap> gaps;          // only where found
  std::vector<TimeRunMatch> matches;  // all pairs that could be compared
  std::vector<TimeClosure> closures;  // all runs over a closed path
  double p_value = 1;                 // of the strongest evidence, corrected for the number of tests
  std::string why;                    // a sentence or two for people
};

struct TimeBaseOptions {
  double significance = 1e-3;
  /// If true, check rows are included. Nothing is fitted or selected with them, and the clock belongs to the
  /// whole record.
  bool with_check_rows = true;
  std::size_t most_pairs = 12;  // largest number of compared pairs of runs
};

/// Compares repetitions. Examines repetitions within a run: the residual of a later pass over the same poses
/// with that of the earlier pass, block by block, over the lag in rows. Examines repetitions between runs
/// over the same path: their residuals along the path. Examines closed paths: the end of the path with its
/// start. A time base error is found if the residuals agree at another lag, significantly better than by
/// chance and than at the lag of the positions. One of three conditions is necessary: the agreement occurs in
/// at least two neighbouring blocks, or row by row between runs whose positions give another rate, or before
/// the path closes. The probabilities of the last two cases are combined (the last case alone is no proof). A
/// residual that is zero, white, smooth, periodic or that really repeats (hysteresis, cyclic errors, drift)
/// gives no finding. Poses that occur only once, or a second pass at another speed, give no information.
/// `residual`: measured - model per observation, mm. Lengths only, rotations are not tested.
TimeBaseFinding examine_time_base(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                                  const TimeBaseOptions& options = {});

}  // namespace vernier::timebase
