// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "tools/fit/convention.h"
#include "tools/fit/fit.h"
#include "tools/fit/problem.h"
#include "tools/fit/settle.h"

namespace vernier::fit {

/// Does `name` match `pattern` (* any letters, ? one letter)?
bool matches_pattern(std::string_view pattern, std::string_view name);

/// The runs that have an observation with role fit.
std::vector<std::string> setups_of_fit_rows(const model::Measurement& m);

/// From the machine's own values, or from nominal where that is nearer, through the stages to the minimum
/// over all parameters, with the solver that `options` name; the convention's scales are in force from the
/// start. Fills iterations, converged and stages of `result`; reads its parameters and its count of
/// observations. Throws InputError for a stage that names nobody. tool.
Eigen::VectorXd solve(FitProblem& problem, const model::Machine& machine, const Convention& convention,
                      const StatedPriors& stated, const FitOptions& options, FitResult& result);

}  // namespace vernier::fit
