// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/solve.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tools/fit/ceres_solver.h"
#include "tools/fit/convention.h"
#include "tools/fit/least_squares/levenberg.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/selection.h"
#include "tools/fit/set_up.h"
#include "tools/text/words.h"

namespace vernier::fit {
namespace {

/// A step that lowers chi^2 by less than this share of one observation's variance moves no
/// parameter by more than sqrt(this) = 3 % of its standard uncertainty. A relative decrease of
/// chi^2 of less than a millionth is negligible too.
constexpr double kNegligible = 1e-3, kNegligibleShare = 1e-6;

/// Noise before the readings' standard deviation is known, without u: this share of the residual
/// of the nominal machine.
constexpr double kFirstNoise = 0.1;

std::vector<Eigen::Index> freed_in(const std::vector<std::string>& patterns,
                                   const model::ParameterSet& parameters) {
  std::set<Eigen::Index> freed;
  for (const std::string& pattern : patterns) {
    bool found = false;
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (matches_pattern(pattern, parameters[i].name)) {
        freed.insert(static_cast<Eigen::Index>(i));
        found = true;
      }
    if (!found)
      throw text::InputError(fmt::format(
          "\"{}\": no free parameter has this name (the JSON result of fit lists the names)", pattern));
  }
  return {freed.begin(), freed.end()};
}

LevenbergOptions own_options(const FitOptions& options, std::size_t observations, Eigen::Index parameters) {
  LevenbergOptions levenberg;
  levenberg.max_iterations = options.max_iterations;
  levenberg.progress = options.progress;
  const double freedom = std::max(1.0, static_cast<double>(observations) - static_cast<double>(parameters));
  levenberg.negligible = [freedom](double cost) {
    return cost * std::max(kNegligible / freedom, kNegligibleShare);
  };
  return levenberg;
}

/// One run of the own solver over the parameters `freed`. The others are constant.
LevenbergResult solve_stage(const FitProblem& problem, const Eigen::VectorXd& start,
                            const std::vector<Eigen::Index>& freed, const FitOptions& options,
                            std::size_t observations) {
  const auto whole = [&](const Eigen::VectorXd& part) {
    Eigen::VectorXd point = start;
    point(freed) = part;
    return point;
  };
  LevenbergOptions levenberg = own_options(options, observations, static_cast<Eigen::Index>(freed.size()));
  levenberg.slope = [&](const Eigen::VectorXd& x) {
    Slope slope = problem.slope(whole(x));
    if (slope.gradient.size() > 0) slope.gradient = slope.gradient(freed).eval();
    return slope;
  };
  const auto equations = [&](const Eigen::VectorXd& x) {
    const NormalEquations all = problem.equations(whole(x));
    return NormalEquations{all.cost, all.normal(freed, freed), all.gradient(freed)};
  };
  LevenbergResult result = minimise(
      start(freed), equations, [&](const Eigen::VectorXd& x) { return problem.cost(whole(x)); }, levenberg);
  result.point = whole(result.point);
  return result;
}

LevenbergResult solve_all(const FitProblem& problem, const Eigen::VectorXd& start, const FitOptions& options,
                          std::size_t observations) {
  LevenbergOptions levenberg = own_options(options, observations, start.size());
  levenberg.slope = [&](const Eigen::VectorXd& x) { return problem.slope(x); };
  levenberg.bend = [&](const Eigen::VectorXd& x, const Eigen::VectorXd& step) {
    return problem.bend(x, step);
  };
  return minimise(
      start, [&](const Eigen::VectorXd& x) { return problem.equations(x); },
      [&](const Eigen::VectorXd& x) { return problem.cost(x); }, levenberg);
}

/// Adds scales and stated priors to the problem's cost.
void hold_near_centre(FitProblem& problem, const Convention& convention, const StatedPriors& stated) {
  const model::Measurement& m = problem.measurement();
  double variance = 1;
  if (!has_uncertainty(m)) {
    const auto noise = noise_um(m);
    variance = std::pow(noise ? 1e-3 * *noise : kFirstNoise * convention.misfit_mm, 2);
    variance = std::max(variance, std::pow(1e-6 * convention.misfit_mm, 2));
  }
  Eigen::SparseMatrix<double> precision = variance * scaled_precision(convention, convention.scale);
  precision += Eigen::SparseMatrix<double>(stated.weight.asDiagonal());
  problem.set_priors(precision, convention.centre);
}

/// Returns the machine's own values with aligned set-ups, or the convention's centre, whichever is
/// nearer. Set-ups always start at their best fit. Components that no reading determines stay at
/// 0.
Eigen::VectorXd nearer_start(const FitProblem& problem, const model::Machine& machine,
                             const Convention& convention, const model::ParameterSet& parameters) {
  const Eigen::VectorXd given = parameters.get(set_up(machine, problem.measurement()));
  return problem.cost(given) < problem.cost(convention.centre) ? given : convention.centre;
}

/// `point` with the shape parameters (periods, time constants) of `given`.
Eigen::VectorXd with_shapes_of(const Eigen::VectorXd& given, const Convention& convention,
                               Eigen::VectorXd point) {
  for (std::size_t i = 0; i < convention.shape.size(); ++i)
    if (convention.shape[i] != 0) point[static_cast<Eigen::Index>(i)] = given[static_cast<Eigen::Index>(i)];
  return point;
}

}  // namespace

Eigen::VectorXd solve(FitProblem& problem, const model::Machine& machine, const Convention& convention,
                      const StatedPriors& stated, const FitOptions& options, FitResult& result) {
  hold_near_centre(problem, convention, stated);
  Eigen::VectorXd point = nearer_start(problem, machine, convention, result.parameters);
  const auto figures = [&](std::string patterns, std::size_t count, int iterations) {
    model::Machine there = machine;
    result.parameters.set(there, point);
    const Eigen::VectorXd left = residuals(there, problem.measurement());
    result.stages.push_back({std::move(patterns), count, iterations,
                             role_statistics(problem.measurement(), left, false),
                             role_statistics(problem.measurement(), left, true)});
  };
  for (const auto& patterns : options.stages) {
    const std::vector<Eigen::Index> freed = freed_in(patterns, result.parameters);
    const LevenbergResult stage = solve_stage(problem, point, freed, options, result.before.count);
    point = stage.point;
    result.iterations += stage.iterations;
    figures(text::joined(patterns, ","), freed.size(), stage.iterations);
  }
  int iterations = 0;
  if (options.solver == Solver::kCeres || options.loss != Loss::kSquared) {
    CeresOutcome outcome = solve_with_ceres(problem, point, options);
    iterations = outcome.iterations;
    result.converged = outcome.converged;
    point = std::move(outcome.point);
    if (options.loss != Loss::kSquared)
      problem.weigh(robust_shares(problem.weighted_residuals(point, nullptr), options.loss, outcome.scale));
  } else {
    LevenbergResult outcome = solve_all(problem, point, options, result.before.count);
    // A period or a time constant has more than one minimum, so the file's own start is tried in
    // addition to the nominal value.
    const Eigen::VectorXd given = with_shapes_of(result.parameters.get(machine), convention, point);
    if (given != point) {
      LevenbergResult other = solve_all(problem, given, options, result.before.count);
      if (other.converged && other.cost < outcome.cost) outcome = std::move(other);
    }
    iterations = outcome.iterations;
    result.converged = outcome.converged;
    point = std::move(outcome.point);
  }
  result.iterations += iterations;
  if (!options.stages.empty()) figures("*", result.parameters.size(), iterations);
  return point;
}

}  // namespace vernier::fit
