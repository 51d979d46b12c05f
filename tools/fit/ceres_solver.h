// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/fit/fit.h"
#include "tools/fit/problem.h"

namespace vernier {

struct CeresOutcome {
  Eigen::VectorXd point;
  int iterations = 0;
  bool converged = false;
};

/// The same problem through Ceres: the path for robust losses, and the cross-check of the solver above. One
/// residual block an observation, analytic derivatives evaluated for all of them at once. tool.
CeresOutcome solve_with_ceres(const FitProblem& problem, const Eigen::VectorXd& start,
                              const FitOptions& options);

}  // namespace vernier
