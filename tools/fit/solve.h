// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/fit/problem.h"
#include "tools/fit/settle.h"
#include "tools/fit/types.h"

namespace vernier::fit {

/// From the machine's own values, or from nominal where that is nearer, through the stages to the minimum
/// over all parameters, with the solver that `options` name; the convention's scales are in force from the
/// start. Fills iterations, converged and stages of `result`; reads its parameters and its count of
/// observations. Throws InputError for a stage that names nobody. tool.
Eigen::VectorXd solve(FitProblem& problem, const model::Machine& machine, const Convention& convention,
                      const StatedPriors& stated, const FitOptions& options, FitResult& result);

}  // namespace vernier::fit
