#pragma once
#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "tools/fit/fit.h"
#include "tools/fit/problem.h"

namespace vernier {

/// Does `name` match `pattern` (* any letters, ? one letter)?
bool matches_pattern(std::string_view pattern, std::string_view name);

/// The runs that have an observation with role fit.
std::vector<std::string> runs_of_fit_rows(const Measurement& m);

/// The start with its BaseShifts alone fitted, if that turns one of them by more than 0.1 deg; else the
/// start. Set-ups so take what they can of a rigid motion before the axes' errors are asked. tool.
Eigen::VectorXd align_set_ups(const Machine& machine, const Measurement& rows, const ParameterSet& all,
                              const Eigen::VectorXd& start);

/// From `point` through the stages to the minimum over all parameters, with the solver that `options` name.
/// Fills iterations, converged and held of `result`; reads its parameters and its count of observations.
/// Throws InputError for a stage that names nobody. tool.
Eigen::VectorXd solve(const FitProblem& problem, Eigen::VectorXd point, const FitOptions& options,
                      FitResult& result);

}  // namespace vernier
