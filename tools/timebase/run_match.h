// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "tools/timebase/revisit.h"

namespace vernier::timebase {

/// Two runs over the same path: the map by their positions, and the map by their residuals.
struct RunMatch {
  PathMap implied, best;           // rows of the second by rows of the first
  double correlation = 0;          // of the smoothed residuals at the best map
  double implied_correlation = 0;  // and at the map by the positions
  /// Probability that residuals of this spectrum agree so well at any tested offset. p_value is also 1 if
  /// they agree no better than at the map by the positions, or if the shift is too small to detect.
  double p_value = 1;
  double shift = 0;  // rows: largest distance of the two maps over the first run
};

struct RunMatchOptions {
  double shifts = 0.30;  // range of tested offsets, as a share of the second run's rows on either side
  int surrogates = 300;
  std::uint64_t seed = 20240613;
  double least_correlation = 0.5;
};

/// Compares two residual series (rows x channels of one unit, without gaps) of runs whose positions map as
/// `implied`. The probability comes from surrogates: the second series with its own spectrum and random
/// phases, the same phases for all channels. A Gumbel law gives the tail beyond the number of surrogates.
/// Runs of opposite direction are distinguished only if the implied rate is not one row per row. Otherwise an
/// error that depends on the direction may look like a constant shift. Returns nullopt if a run is shorter
/// than 150 rows or without residual. Source: Theiler et al., Physica D 58 (1992), surrogate data.
std::optional<RunMatch> match_runs(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second,
                                   const PathMap& implied, const RunMatchOptions& options = {});

}  // namespace vernier::timebase
