// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

namespace vernier::timebase {

/// A block of a series, compared with the most similar later block. Rows are of the series. A lag
/// is in rows, later minus earlier.
struct RepeatBlock {
  std::size_t first = 0, last = 0;  // rows of the earlier block, inclusive
  double lag = 0;                   // of the best agreement, interpolated between rows by a parabola
  double implied_lag = 0;           // at which the same poses return
  double correlation = 0, implied_correlation = 0;  // concordance (Lin), without the trend
  double difference = 0, implied_difference = 0;    // rms, in the unit of the series, without the trend
  double p_agreement = 1;  // probability that unrelated data agree so well at a given lag
  double p_at_lag =
      1;  // the same, or that noise alone makes the implied lag so much worse: the larger probability
  double p_value = 1;  // the same for the best of all tested lags
  double tried = 1;    // effective number of tested lags: lags that are not neighbours
};

struct RepeatOptions {
  std::size_t block = 0;  // rows; 0: a sixteenth of the implied lag, within 60 and 400
  double search = 0.15;   // range of tested lags, as a share of the implied lag on either side
  double tolerance = 2;   // rows; a smaller difference of lags is not a finding
};

/// Compares each block of a series with later rows, at all lags about the implied lag. `series`:
/// rows x channels of one unit, NaN if not measured. `implied_lag`: per row, NaN if the pose does
/// not return. Blocks follow one another without overlap. A block without a whole implied lag is
/// excluded. Source: Lin, Biometrics 45 (1989) for the concordance; Bartlett's effective
/// number of rows.
std::vector<RepeatBlock> compare_repeats(const Eigen::MatrixXd& series, const Eigen::VectorXd& implied_lag,
                                         const RepeatOptions& options = {});

/// Returns the blocks with a reliable lag, shifted or not: each agrees with a neighbouring block within the
/// tolerance (the lag of an isolated block may be due to chance).
std::vector<std::size_t> trusted_blocks(const std::vector<RepeatBlock>& blocks,
                                        const RepeatOptions& options = {});

/// Neighbouring reliable blocks with the same shift.
struct RepeatLevel {
  std::vector<std::size_t> blocks;
  double lag = 0, uncertainty = 0;  // mean of the blocks and its standard uncertainty, rows
  double shift = 0;                 // mean of lag - implied lag
  double p_agreement =
      1;               // probability that unrelated data agree so well somewhere in the record, at some lag
  double p_value = 1;  // the same, and so much better than at the implied lag
};

/// Returns the levels in order of their rows. The probability of a level combines those of its blocks
/// (Stouffer), multiplied by the number of lags and blocks that were available.
std::vector<RepeatLevel> repeat_levels(const std::vector<RepeatBlock>& blocks,
                                       const RepeatOptions& options = {});

/// A jump of the best lag between two reliable blocks: rows are missing from one of the two passes at the
/// jump.
struct LagJump {
  std::size_t row = 0;           // of the earlier pass: the first without the old lag
  double row_uncertainty = 0;    // rows, half of the range within which both lags fit nearly as well
  double before = 0, after = 0;  // lags
  double uncertainty = 0;        // rows, standard, of after - before

  /// Returns the number of missing rows: from the later pass if the lag decreases, from the earlier pass if
  /// it increases.
  double missing() const { return after < before ? before - after : after - before; }
  bool in_later_pass() const { return after < before; }
  /// Returns the row of the series before which rows are missing.
  std::size_t missing_before() const {
    return in_later_pass() ? row + static_cast<std::size_t>(std::lround(before)) : row;
  }
};

/// Returns jumps larger than the tolerance. Each jump is at the row that minimises the sum of squares on both
/// sides. Rows of the earlier pass whose repetition is missing count on neither side.
std::vector<LagJump> lag_jumps(const Eigen::MatrixXd& series, const std::vector<RepeatBlock>& blocks,
                               const RepeatOptions& options = {});

}  // namespace vernier::timebase
