// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/fit/least_squares/problem.h"
#include "tools/fit/types.h"

namespace vernier::fit {

struct CeresOutcome {
  Eigen::VectorXd point;
  int iterations = 0;
  bool converged = false;
  double scale = 1;  // weighted residual above which the robust loss reduces the weight of a reading
};

/// Returns the factors by which a robust loss weights readings with these weighted residuals. A
/// reading keeps its full weight (factor 1) if its weighted residual is within the scale of the
/// robust loss. The weighted square of an outlier is then the square of the scale of the loss. The
/// square of the scale of the loss is the influence of the outlier on a robust fit (Huber 1981,
/// 6.7).
Eigen::VectorXd robust_shares(const Eigen::VectorXd& residual, Loss loss, double scale);

/// Solves the fit problem with Ceres, for robust losses and as a cross-check of the default solver. The Ceres
/// problem has one residual block per observation. The analytic derivatives of all observations are evaluated
/// in one step.
CeresOutcome solve_with_ceres(const FitProblem& problem, const Eigen::VectorXd& start,
                              const FitOptions& options);

}  // namespace vernier::fit
