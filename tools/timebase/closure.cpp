// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/timebase/closure.h"

#include <algorithm>
#include <cmath>

#include "tools/timebase/stretch.h"

namespace vernier::timebase {
namespace {

using Index = Eigen::Index;

bool closes(const Eigen::MatrixXd& points) {
  const Index last = points.rows() - 1;
  const Eigen::RowVectorXd step = points.row(last) - points.row(last - 1),
                           first_step = points.row(1) - points.row(0);
  const Eigen::RowVectorXd next = points.row(last) + step;
  constexpr double kGap = 1.5;  // steps between the end of a closed path and its beginning: one, and a margin
  return step.norm() > 0 && (next - points.row(0)).norm() <= kGap * step.norm() && step.dot(first_step) > 0;
}

Closure compare_ends(const Eigen::MatrixXd& series, Index rows) {
  Closure closure;
  closure.rows = rows;
  const auto head = stretch(series, 0, rows), tail = stretch(series, series.rows() - rows, rows);
  if (!head || !tail) return closure;
  closure.correlation = concordance(*head, *tail);
  closure.p_value = chance_of_agreement(closure.correlation, effective_rows(*head, *tail));
  return closure;
}

double best_elsewhere(const Eigen::MatrixXd& series, Index rows) {
  double best = -1;
  const Eigen::MatrixXd head = *stretch(series, 0, rows);
  for (Index first = rows / 2; first + 2 * rows < series.rows(); ++first) {
    if (const auto other = stretch(series, first, rows)) best = std::max(best, concordance(head, *other));
  }
  return best;
}

}  // namespace

std::optional<Closure> examine_closure(const Eigen::MatrixXd& points, const Eigen::MatrixXd& series) {
  // Minimum number of readings of a clock, and of a run, for a test of repeats.
  constexpr Index kFewest = 12, kShortestRun = 200;
  constexpr Index kPart = 7;  // a seventh of the turn: beyond it the path does not close
  const Index most = series.rows() / kPart;
  if (series.rows() < kShortestRun || points.cols() == 0 || !series.allFinite() || !closes(points))
    return std::nullopt;
  Closure best;
  for (Index rows = kFewest; rows <= most; ++rows) {
    const Closure closure = compare_ends(series, rows);
    if (closure.p_value < best.p_value) best = closure;
  }
  if (best.p_value >= 1) return best;
  best.p_value = std::min(1.0, best.p_value * static_cast<double>(most - kFewest + 1));
  best.elsewhere = best_elsewhere(series, best.rows);
  // If another part is nearly as similar (half of the rest unexplained), it is a period of the
  // path itself.
  if (1 - best.elsewhere < 2 * (1 - best.correlation)) best.p_value = 1;
  return best;
}

}  // namespace vernier::timebase
