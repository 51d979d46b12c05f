// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>

namespace vernier::timebase {

/// Comparison of the end of a run over a closed path with its start. If readings and positions belong to the
/// same times, the residual repeats when the path closes, and not earlier.
struct Closure {
  Eigen::Index rows = 0;   // number of rows at the end that repeat the start: the surplus of samples in the
                           // closed path
  double correlation = 0;  // concordance correlation of the end with the start, without their trend
  double elsewhere = 0;    // largest concordance correlation of the start with the rest of the run
  double p_value =
      1;  // probability that the end of a correct record is so similar to its start, for any number of rows
};

/// Tests whether the last rows of a run repeat its first rows. `points`: the path, which must close (the pose
/// after the last row is the first pose). `series`: rows x channels of one unit, without gaps. Returns
/// nullopt if the path does not close (end at its start). If the start is also similar to other parts of the
/// run (a periodic error), examine_closure returns no finding.
std::optional<Closure> examine_closure(const Eigen::MatrixXd& points, const Eigen::MatrixXd& series);

}  // namespace vernier::timebase
