// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

namespace vernier::timebase {

/// A stretch of a series beside the later stretch that resembles it most. Rows are of the series; a lag is in
/// rows, later minus earlier.
struct RepeatBlock {
  std::size_t first = 0, last = 0;                  // rows of the earlier stretch, inclusive
  double lag = 0;                                   // at which they agree best, between rows by a parabola
  double implied_lag = 0;                           // at which the same poses come again
  double correlation = 0, implied_correlation = 0;  // concordance (Lin), trend taken off
  double difference = 0, implied_difference = 0;    // rms, in the unit of the series, trend taken off
  double p_agreement = 1;  // chance that what is unrelated agrees so well at a given lag
  double p_at_lag = 1;     // the same, or that noise alone makes the implied lag so much worse: the larger
  double p_value = 1;      // the same for the best of all lags tried
  double tried = 1;        // lags that are not neighbours of one another, as many as were looked at
};

struct RepeatOptions {
  std::size_t block = 0;  // rows; 0: a sixteenth of the implied lag, within 60 and 400
  double search = 0.15;   // lags looked at, as a share of the implied lag either side
  double tolerance = 2;   // rows; a smaller difference of lags is no finding
};

/// Compares each block of a series with what comes later, at all lags about the implied one. `series`: rows x
/// channels of one unit, NaN where not measured. `implied_lag`: per row, NaN where the pose does not come
/// again. Blocks follow one another without overlap; one without a whole implied lag is left out. tool.
/// Source: Lin, Biometrics 45 (1989) for the concordance; Bartlett's effective number of rows.
std::vector<RepeatBlock> compare_repeats(const Eigen::MatrixXd& series, const Eigen::VectorXd& implied_lag,
                                         const RepeatOptions& options = {});

/// Blocks whose lag can be trusted: each agrees with a neighbour within the tolerance (that of an isolated
/// block may be a chance). Shifted or not. tool.
std::vector<std::size_t> trusted_blocks(const std::vector<RepeatBlock>& blocks,
                                        const RepeatOptions& options = {});

/// Neighbouring trusted blocks with one and the same shift.
struct RepeatLevel {
  std::vector<std::size_t> blocks;
  double lag = 0, uncertainty = 0;  // mean of the blocks and its standard uncertainty, rows
  double shift = 0;                 // mean of lag - implied lag
  double p_agreement = 1;           // that what is unrelated agrees so somewhere in the record, at some lag
  double p_value = 1;               // the same, and so much better than at the implied lag
};

/// Levels in order of their rows. The chance joins those of the blocks (Stouffer), times the lags and the
/// stretches that there were to choose from. tool.
std::vector<RepeatLevel> repeat_levels(const std::vector<RepeatBlock>& blocks,
                                       const RepeatOptions& options = {});

/// Where the best lag jumps between two trusted blocks: rows are missing from one of the two passes there.
struct LagJump {
  std::size_t row = 0;           // of the earlier pass: the first without the old lag
  double row_uncertainty = 0;    // rows, half of the stretch within which both lags do about as well
  double before = 0, after = 0;  // lags
  double uncertainty = 0;        // rows, standard, of after - before

  /// Rows missing: from the later pass where the lag falls, from the earlier one where it grows.
  double missing() const { return after < before ? before - after : after - before; }
  bool in_later_pass() const { return after < before; }
  /// The row of the series before which they are missing.
  std::size_t missing_before() const {
    return in_later_pass() ? row + static_cast<std::size_t>(std::lround(before)) : row;
  }
};

/// Jumps larger than the tolerance, each placed where the sum of squares on both sides is least; rows of the
/// earlier pass whose repetition is missing count on neither. tool.
std::vector<LagJump> lag_jumps(const Eigen::MatrixXd& series, const std::vector<RepeatBlock>& blocks,
                               const RepeatOptions& options = {});

}  // namespace vernier::timebase
