#include "tools/fit/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/fit/problem.h"
#include "tools/fit/solve.h"
#include "tools/model/evaluate.h"
#include "tools/model/prediction.h"

namespace vernier {
namespace {

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
  const NormalEquations end = problem.equations(values);
  result.observability = observe(end.normal, kUnseenShare, result.held);
  result.chi_square = end.cost;
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

/// 1 / std^2 of each parameter that a prior names, 0 for the others. A prior that names nothing is a mistake.
Eigen::VectorXd prior_weights(FitResult& result, const FitOptions& options) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(result.parameters.size()));
  for (const Prior& prior : options.priors) {
    bool found = false;
    for (std::size_t i = 0; i < result.parameters.size(); ++i) {
      if (!matches_pattern(prior.pattern, result.parameters[i].name)) continue;
      found = true;
      weights[static_cast<Eigen::Index>(i)] = 1 / (prior.std * prior.std);
      result.priors.emplace_back(result.parameters[i].name, prior.std);
    }
    if (!found) throw InputError("\"" + prior.pattern + "\": no free parameter has this name");
  }
  return weights;
}

std::vector<Correlation> strong_correlations(const Observability& seen) {
  constexpr double kStrong = 0.9;
  std::vector<Correlation> list;
  const Eigen::VectorXd std = seen.covariance.diagonal().cwiseSqrt();
  for (Eigen::Index i = 0; i < std.size(); ++i)
    for (Eigen::Index k = 0; k < i; ++k) {
      const auto first = static_cast<std::size_t>(k), second = static_cast<std::size_t>(i);
      if (seen.determined[first] == 0 || seen.determined[second] == 0 || std[i] <= 0 || std[k] <= 0) continue;
      const double value = seen.covariance(i, k) / (std[i] * std[k]);
      if (std::abs(value) > kStrong) list.push_back({first, second, value});
    }
  std::sort(list.begin(), list.end(),
            [](const Correlation& a, const Correlation& b) { return std::abs(a.value) > std::abs(b.value); });
  return list;
}

/// residual / sqrt(u^2 + g C g^T) over the check rows; u is the reading's own, without it the fit's spread.
std::optional<NormalisedError> normalised_error(const FitResult& result, const Measurement& m) {
  if (result.check.count == 0 || result.freedom <= 0) return std::nullopt;
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < m.rows(); ++row)
    if (m.check[row] != 0) keep.push_back(row);
  const Measurement rows = uses_lag(result.machine) ? m : select_rows(m, keep);
  const Linearisation linear = linearise(result.machine, rows, result.parameters);
  NormalisedError error;
  for (std::size_t i = 0; i < rows.observations.size(); ++i) {
    const Observation& o = rows.observations[i];
    if (rows.check[o.row] == 0) continue;
    const auto at = static_cast<Eigen::Index>(i);
    double model = 0;
    for (SparseRows::InnerIterator a(linear.jacobian, at); a; ++a)
      for (SparseRows::InnerIterator b(linear.jacobian, at); b; ++b)
        model += a.value() * b.value() * result.observability.covariance(a.col(), b.col());
    const double u = rows.uncertainty[static_cast<Eigen::Index>(o.row)];
    const double reading = u > 0 ? u * u : result.variance_factor;
    const double e = (o.value - linear.predicted[at]) / std::sqrt(reading + result.variance_factor * model);
    error.rms += e * e;
    error.within_3 += std::abs(e) <= 3 ? 1 : 0;
    ++error.count;
  }
  if (error.count == 0) return std::nullopt;
  error.rms = std::sqrt(error.rms / static_cast<double>(error.count));
  error.within_3 /= static_cast<double>(error.count);
  return error;
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
  FitProblem problem(machine, rows, result.parameters);
  const Eigen::VectorXd start = result.parameters.get(machine);
  problem.set_priors(prior_weights(result, options), start);
  const Eigen::VectorXd end =
      solve(problem, align_set_ups(machine, rows, result.parameters, start), options, result);
  result.parameters.set(result.machine, end);
  result.residual = residuals(result.machine, measurement);
  result.after = role_statistics(measurement, result.residual, false);
  result.check = role_statistics(measurement, result.residual, true);
  estimate(result, problem, has_uncertainty(measurement));
  result.correlations = strong_correlations(result.observability);
  result.normalised_check = normalised_error(result, measurement);
  return result;
}

}  // namespace vernier
