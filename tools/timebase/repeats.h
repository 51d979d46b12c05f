// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

namespace vernier::timebase {

/// A block of a series, compared with the later block that is most similar to it. The row numbers of a
/// RepeatBlock are those of the series. A lag is the number of rows between the blocks, later minus earlier.
struct RepeatBlock {
  std::size_t first = 0, last = 0;  // first and last row of the earlier block
  double lag = 0;                   // lag with the best agreement, interpolated between rows by a parabola
  double implied_lag = 0;           // lag at which the poses repeat
  double correlation = 0, implied_correlation = 0;  // concordance correlations (Lin) at both lags, without
                                                    // the trend
  double difference = 0, implied_difference = 0;    // rms differences at both lags, in the unit of the
                                                    // series, without the trend
  double p_agreement = 1;  // probability that unrelated data agree so well at one given lag
  double p_at_lag = 1;     // larger of two probabilities: p_agreement, and the probability that noise alone
                           // makes the agreement at the implied lag so much worse
  double p_value = 1;      // the same probability for the best of all tested lags
  double tried = 1;        // effective number of tested lags (without neighbouring lags)
};

struct RepeatOptions {
  std::size_t block = 0;  // length of a block, rows; 0: one sixteenth of the implied lag, between 60 and 400
  double search = 0.15;   // range of tested lags on both sides, as a share of the implied lag
  double tolerance = 2;   // in rows; a smaller difference between two lags is not a finding
};

/// Compares each block of a series with later rows, at all lags near the implied lag. `series`: rows x
/// channels of one unit; NaN if not measured. `implied_lag`: lag at which the pose repeats, for each row; NaN
/// if the pose does not repeat. The blocks follow one another without overlap. A block is excluded if the
/// implied lag of one of its rows is missing, or if the implied lag varies in the block by more than the
/// tolerance. Sources: Lin, Biometrics 45 (1989) for the concordance; Bartlett for the effective number of
/// rows.
std::vector<RepeatBlock> compare_repeats(const Eigen::MatrixXd& series, const Eigen::VectorXd& implied_lag,
                                         const RepeatOptions& options = {});

/// Returns the blocks with a reliable lag, shifted or not. The lag of a reliable block agrees with that of a
/// neighbouring block within the tolerance, because the lag of an isolated block may be due to chance.
std::vector<std::size_t> trusted_blocks(const std::vector<RepeatBlock>& blocks,
                                        const RepeatOptions& options = {});

/// A level: neighbouring reliable blocks with the same shift of the lag.
struct RepeatLevel {
  std::vector<std::size_t> blocks;
  double lag = 0, uncertainty = 0;  // mean lag of the blocks and its standard uncertainty, rows
  double shift = 0;                 // mean of (lag - implied lag)
  double p_agreement =
      1;               // probability that unrelated data agree so well somewhere in the record, at any lag
  double p_value = 1;  // probability that unrelated data agree so well, and so much better than at the
                       // implied lag
};

/// Returns the levels in the order of their rows. The probability of a level combines the probabilities of
/// its blocks (Stouffer). The combined probability of a level is multiplied by the number of possible lags
/// and blocks.
std::vector<RepeatLevel> repeat_levels(const std::vector<RepeatBlock>& blocks,
                                       const RepeatOptions& options = {});

/// A jump of the best lag between two reliable blocks. At the jump, rows are missing in one of the two
/// passes.
struct LagJump {
  std::size_t row = 0;           // row of the earlier pass: the first row that no longer has the old lag
  double row_uncertainty = 0;    // in rows: half of the range in which both lags fit nearly as well
  double before = 0, after = 0;  // lags before and after the jump
  double uncertainty = 0;        // standard uncertainty of after - before, rows

  /// Returns the number of missing rows. The rows are missing in the later pass if the lag decreases, and in
  /// the earlier pass if it increases.
  double missing() const { return after < before ? before - after : after - before; }
  bool in_later_pass() const { return after < before; }
  /// Returns the row of the series before which the rows are missing.
  std::size_t missing_before() const {
    return in_later_pass() ? row + static_cast<std::size_t>(std::lround(before)) : row;
  }
};

/// Returns the jumps of the lag that are larger than the tolerance. Each jump is at the row that minimises
/// the sum of squares before and after the jump. A row of the earlier pass whose repetition is missing is not
/// counted, neither before nor after the jump.
std::vector<LagJump> lag_jumps(const Eigen::MatrixXd& series, const std::vector<RepeatBlock>& blocks,
                               const RepeatOptions& options = {});

}  // namespace vernier::timebase
