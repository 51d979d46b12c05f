// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/fit/least_squares/problem.h"
#include "tools/fit/settle.h"
#include "tools/fit/types.h"

namespace vernier::fit {

/// Starts from the values of the machine file, or from nominal if nominal has the lower cost, and goes
/// through the stages to the minimum over all parameters. solve() uses the solver that `options` name. The
/// convention's scales apply from the start. Fills iterations, converged and stages of `result`. Reads the
/// parameters of `result` and its number of observations. Throws InputError for a stage that matches no
/// parameter.
Eigen::VectorXd solve(FitProblem& problem, const model::Machine& machine, const Convention& convention,
                      const StatedPriors& stated, const FitOptions& options, FitResult& result);

}  // namespace vernier::fit
