// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tools/diagnose/propose/evidence.h"

namespace vernier::diagnose {

/// Result of a leave-one-block-out test of the columns (regressors) that a model would gain.
struct HeldOut {
  double chi_square = 0;  // sum over all rows; each row is predicted from the other blocks
  /// The density of the blocks, each predicted from the others, with the covariance of the prediction: the
  /// sum of squares in units of this covariance, and the logarithm of its determinant. Both are for readings
  /// with the variance 1.
  double predicted_square = 0, predicted_log_determinant = 0;
  std::vector<double> agreement;  // cosine, for each block left out, between the contribution of the watched
                                  // columns in this block and in all blocks
};

/// Leave-one-block-out test: predicts every block of the fit rows from the other blocks. The regressors are
/// the free parameters of the model and `columns`, after projection on the orthogonal complement of those
/// parameters. Parameters that only the held-out block determines are fitted to the held-out block.
/// `watched_first`, `watched_count`: first index and number of the columns whose agreement is reported.
/// `blocks`: the index of the block for each fit observation; a negative index is never held out.
HeldOut leave_blocks_out(const Evidence& evidence, const Eigen::MatrixXd& columns, Eigen::Index watched_first,
                         Eigen::Index watched_count, const std::vector<int>& blocks);

/// Returns the blocks for held-out tests over levels of the feed and of each thermometer. All rows with one
/// level of feed, or of one temperature, are in one block. A term that was learned on features must be
/// confirmed on held-out levels of feed and temperature, because features depend on both quantities. The
/// result of level_blocks() has one list of blocks for each quantity (feed, thermometer) with at least two
/// levels.
std::vector<std::vector<int>> level_blocks(const Evidence& evidence);

/// Returns blocks of rows. All rows at one position are in the same block. Three divisions into blocks are
/// possible: the three inner ones of five consecutive parts of the range of an axis; every fifth position of
/// the axis; the corners of the measured volume. The corners are the halves of the three axes with the most
/// positions. Other rows at the same position cannot contradict what a term does between the positions. The
/// result has one list for each of these divisions that has two blocks or more. axis: nullopt for the corners
/// alone.
std::vector<std::vector<int>> place_blocks(const Evidence& evidence, std::optional<std::size_t> axis);

}  // namespace vernier::diagnose
