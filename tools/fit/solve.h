// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/fit/least_squares/problem.h"
#include "tools/fit/settle.h"
#include "tools/fit/types.h"

namespace vernier::fit {

/// Minimises the cost of a fit with the solver that `options` name, and returns the parameters at the
/// minimum. The start is the machine file, or nominal if nominal has the lower cost. The fit frees the
/// parameters of one stage after another, and at the end all parameters. The scales of the convention are
/// used from the start of the fit. Sets the members iterations, converged and stages of `result`. Uses the
/// parameters of `result` and its number of observations as input. Throws InputError if the patterns of a
/// stage match no parameter.
Eigen::VectorXd solve(FitProblem& problem, const model::Machine& machine, const Convention& convention,
                      const StatedPriors& stated, const FitOptions& options, FitResult& result);

}  // namespace vernier::fit
