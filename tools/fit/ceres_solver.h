// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/fit/problem.h"
#include "tools/fit/types.h"

namespace vernier::fit {

struct CeresOutcome {
  Eigen::VectorXd point;
  int iterations = 0;
  bool converged = false;
  double scale = 1;  // weighted residual beyond which the loss lets go
};

/// Shares by which a loss counts readings with these weighted residuals (1 within its scale): a reading far
/// off then adds the square of the scale to the sum of squares, as its influence on a robust fit is (Huber
/// 1981, 6.7). tool.
Eigen::VectorXd robust_shares(const Eigen::VectorXd& residual, Loss loss, double scale);

/// The same problem through Ceres: the path for robust losses, and the cross-check of the solver above. One
/// residual block an observation, analytic derivatives evaluated for all of them at once. tool.
CeresOutcome solve_with_ceres(const FitProblem& problem, const Eigen::VectorXd& start,
                              const FitOptions& options);

}  // namespace vernier::fit
