// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <optional>

namespace vernier::timebase {

/// The end of a run over a closed path beside its beginning: what the path does after closing has come before
/// the positions close.
struct Closure {
  Eigen::Index rows = 0;   // of the end that repeat the beginning: so many samples the turn is too long
  double correlation = 0;  // concordance, trend taken off
  double elsewhere = 0;    // the best concordance of the beginning with the rest of the run
  double p_value = 1;  // that the end of a right record resembles its beginning so, for some number of rows
};

/// Do the last rows of a run repeat its first ones? `points`: the path, which must close (the pose after the
/// last row is the first); `series`: rows x channels of one unit, no gaps. Nothing where the path does not
/// close. A beginning that also resembles other places of the run (a periodic error) is no finding. tool.
std::optional<Closure> examine_closure(const Eigen::MatrixXd& points, const Eigen::MatrixXd& series);

}  // namespace vernier::timebase
