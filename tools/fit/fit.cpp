#include "tools/fit/fit.h"

#include <cmath>
#include <limits>

#include "tools/fit/ceres_solver.h"
#include "tools/fit/levenberg.h"
#include "tools/fit/problem.h"
#include "tools/model/evaluate.h"
#include "tools/model/prediction.h"

namespace vernier {
namespace {

/// A step that lowers chi^2 by less than this share of one observation's variance moves no parameter by more
/// than sqrt(this) = 3 % of its standard uncertainty; nor is it worth more when it lowers chi^2 by less than
/// a millionth.
constexpr double kNegligible = 1e-3, kNegligibleShare = 1e-6;

std::vector<std::string> runs_of_fit_rows(const Measurement& m) {
  std::vector<char> seen(m.states.run_names.size(), 0);
  for (const Observation& o : m.observations)
    if (m.check[o.row] == 0) seen[m.states.run[o.row]] = 1;
  std::vector<std::string> runs;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] != 0) runs.push_back(m.states.run_names[i]);
  return runs;
}

/// The rows that the fit needs: its own, or all where lag makes a row depend on those before it.
Measurement rows_for_fit(const Machine& machine, const Measurement& all) {
  if (uses_lag(machine)) return all;
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < all.rows(); ++row)
    if (all.check[row] == 0) keep.push_back(row);
  return keep.size() == all.rows() ? all : select_rows(all, keep);
}

void estimate(FitResult& result, const FitProblem& problem, bool has_u) {
  const Eigen::VectorXd values = result.parameters.get(result.machine);
  result.observability = observe(problem.equations(values).normal);
  result.chi_square = problem.cost(values);
  result.freedom = static_cast<Eigen::Index>(result.before.count) - result.observability.rank;
  const double reduced = result.freedom > 0 ? result.chi_square / static_cast<double>(result.freedom)
                                            : std::numeric_limits<double>::quiet_NaN();
  result.variance_factor = has_u ? (reduced > 1 ? reduced : 1) : reduced;
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    ParameterEstimate item{result.parameters[i].name, result.parameters[i].unit, values[at], std::nullopt};
    const double variance = result.variance_factor * result.observability.covariance(at, at);
    if (result.observability.determined[i] != 0 && std::isfinite(variance)) item.std = std::sqrt(variance);
    result.estimates.push_back(item);
  }
}

}  // namespace

Eigen::VectorXd residuals(const Machine& machine, const Measurement& m) {
  const Eigen::VectorXd predicted = predict(machine, m);
  Eigen::VectorXd result(predicted.size());
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    result[at] = m.observations[i].value - predicted[at];
  }
  return result;
}

FitResult fit(const Machine& machine, const Measurement& measurement, const FitOptions& options) {
  FitResult result;
  result.machine = machine;
  result.parameters = ParameterSet(machine, runs_of_fit_rows(measurement));
  const Eigen::VectorXd start_residual = residuals(machine, measurement);
  result.before = role_statistics(measurement, start_residual, false);
  if (result.before.count == 0) throw InputError("no observation with role fit: there is nothing to fit");
  result.noise_um = noise_um(measurement);
  const Measurement rows = rows_for_fit(machine, measurement);
  const FitProblem problem(machine, rows, result.parameters);
  const Eigen::VectorXd start = result.parameters.get(machine);
  Eigen::VectorXd end;
  if (options.solver == Solver::kCeres || options.loss != Loss::kSquared) {
    const CeresOutcome outcome = solve_with_ceres(problem, start, options);
    end = outcome.point;
    result.iterations = outcome.iterations;
    result.converged = outcome.converged;
  } else {
    LevenbergOptions levenberg;
    levenberg.max_iterations = options.max_iterations;
    levenberg.progress = options.progress;
    const double freedom =
        std::max(1.0, static_cast<double>(result.before.count) - static_cast<double>(start.size()));
    levenberg.negligible = [freedom](double cost) {
      return cost * std::max(kNegligible / freedom, kNegligibleShare);
    };
    const LevenbergResult outcome = minimise(
        start, [&](const Eigen::VectorXd& x) { return problem.equations(x); },
        [&](const Eigen::VectorXd& x) { return problem.cost(x); }, levenberg);
    end = outcome.point;
    result.iterations = outcome.iterations;
    result.converged = outcome.converged;
  }
  result.parameters.set(result.machine, end);
  result.residual = residuals(result.machine, measurement);
  result.after = role_statistics(measurement, result.residual, false);
  result.check = role_statistics(measurement, result.residual, true);
  estimate(result, problem, has_uncertainty(measurement));
  return result;
}

}  // namespace vernier
