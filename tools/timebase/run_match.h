// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "tools/timebase/revisit.h"

namespace vernier::timebase {

/// Comparison of two runs over the same path: the relation of their rows by the positions, and the relation
/// by the residuals.
struct RunMatch {
  PathMap implied, best;           // relation of the rows by the positions, and by the residuals
  double correlation = 0;          // correlation of the smoothed residuals with the best relation
  double implied_correlation = 0;  // correlation of the smoothed residuals with the relation by the positions
  /// Probability that residuals with this spectrum agree so well at any tested offset. The value p_value is
  /// also 1 if the shift is too small to detect, or if the best correlation is below `least_correlation`. The
  /// value p_value is also 1 if implied_correlation is above half of the best correlation.
  double p_value = 1;
  double shift = 0;  // in rows: largest difference between both relations over the first run
};

struct RunMatchOptions {
  double shifts = 0.30;  // range of tested offsets on both sides, as a share of the second run's rows
  int surrogates = 300;
  std::uint64_t seed = 20240613;
  double least_correlation = 0.5;
};

/// Compares the residuals of two runs (rows x channels of one unit, without gaps) whose positions have the
/// relation `implied`. The probability is computed with surrogate series: the second series with its own
/// spectrum and random phases, which are equal for all channels. A Gumbel distribution gives the
/// probabilities that are smaller than the number of surrogates permits. For two runs in opposite directions,
/// a shift is a finding only if the implied rate differs from one row per row. For runs in opposite
/// directions with a rate of one row per row, an error that depends on the direction could look like a
/// constant shift. Returns nullopt if a run has fewer than 150 rows or no residual. The surrogate data are
/// those of Theiler et al., Physica D 58 (1992).
std::optional<RunMatch> match_runs(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second,
                                   const PathMap& implied, const RunMatchOptions& options = {});

}  // namespace vernier::timebase
