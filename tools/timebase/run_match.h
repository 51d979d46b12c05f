// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "tools/timebase/revisit.h"

namespace vernier::timebase {

/// Two runs over the same path: where the positions put the second beside the first, and where their
/// residuals agree.
struct RunMatch {
  PathMap implied, best;           // rows of the second by rows of the first
  double correlation = 0;          // of the smoothed residuals at the best map
  double implied_correlation = 0;  // and where the positions say
  /// Chance that residuals of this spectrum agree so well at any offset looked at; 1 also where they agree no
  /// better than the positions say or the shift is too small to tell.
  double p_value = 1;
  double shift = 0;  // rows: greatest distance of the two maps over the first run
};

struct RunMatchOptions {
  double shifts = 0.30;  // offsets looked at, as a share of the second run's rows either side
  int surrogates = 300;
  std::uint64_t seed = 20240613;
  double least_correlation = 0.5;
};

/// Compares two residual series (rows x channels of one unit, no gaps) of runs whose positions map as
/// `implied`. The chance is that of surrogates: the second series with its own spectrum and random phases,
/// the same for all channels; the tail beyond their number by a Gumbel law. Runs of opposite direction are
/// distinguished only where the implied rate is not one row a row: an error that depends on the sense may
/// look like a constant shift. Nothing where a run is shorter than 150 rows or without residual. tool.
/// Source: Theiler et al., Physica D 58 (1992), surrogate data.
std::optional<RunMatch> match_runs(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second,
                                   const PathMap& implied, const RunMatchOptions& options = {});

}  // namespace vernier::timebase
