#include "tools/fit/solve.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tools/fit/ceres_solver.h"
#include "tools/fit/levenberg.h"

namespace vernier {
namespace {

/// A step that lowers chi^2 by less than this share of one observation's variance moves no parameter by more
/// than sqrt(this) = 3 % of its standard uncertainty; nor is it worth more when it lowers chi^2 by less than
/// a millionth.
constexpr double kNegligible = 1e-3, kNegligibleShare = 1e-6;

/// Where the set-ups stand is whatever the start says, and a set-up that is turned by more than this (deg)
/// has its turn's second order, half its square times the reach, taken for errors of the axes.
constexpr double kTurned_deg = 0.1;

std::vector<Eigen::Index> freed_in(const std::vector<std::string>& patterns, const ParameterSet& parameters) {
  std::set<Eigen::Index> freed;
  for (const std::string& pattern : patterns) {
    bool found = false;
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (matches_pattern(pattern, parameters[i].name)) {
        freed.insert(static_cast<Eigen::Index>(i));
        found = true;
      }
    if (!found) throw InputError("\"" + pattern + "\": no free parameter has this name");
  }
  return {freed.begin(), freed.end()};
}

/// The largest turn (deg) in the first step of a problem of BaseShifts.
double first_turn_deg(const FitProblem& problem, const ParameterSet& shifts, const Eigen::VectorXd& from) {
  NormalEquations first = problem.equations(from);
  first.normal.diagonal() *= 1 + 1e-9;  // a set-up seen at too few points stays where it is
  const Eigen::VectorXd step = first.normal.ldlt().solve(first.gradient);
  double turn_deg = 0;
  for (std::size_t i = 0; i < shifts.size(); ++i)
    if (shifts[i].column >= 3) turn_deg = std::max(turn_deg, std::abs(step[static_cast<Eigen::Index>(i)]));
  return turn_deg;
}

/// Angles that products of errors alone ask for, and by more than this, are an imitation.
constexpr double kMostTurned_deg = 0.5;

bool turned_little(const ParameterSet& parameters, const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double turn = std::abs(to[at] - from[at]);
    const std::string& unit = parameters[i].unit;
    if ((unit == "deg" && turn > kMostTurned_deg) ||
        (unit == "rad" && turn * 180 / std::numbers::pi > kMostTurned_deg))
      return false;
  }
  return true;
}

LevenbergOptions own_options(const FitOptions& options, std::size_t observations, Eigen::Index parameters) {
  LevenbergOptions levenberg;
  levenberg.max_iterations = options.max_iterations;
  levenberg.progress = options.progress;
  const double freedom = std::max(1.0, static_cast<double>(observations) - static_cast<double>(parameters));
  levenberg.negligible = [freedom](double cost) {
    return cost * std::max(kNegligible / freedom, kNegligibleShare);
  };
  levenberg.chance = [freedom](double cost) { return cost / freedom; };
  return levenberg;
}

/// One run of the own solver over the parameters `freed`; the others stay.
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

LevenbergResult solve_all(const FitProblem& problem, const ParameterSet& parameters,
                          const Eigen::VectorXd& start, const FitOptions& options, std::size_t observations) {
  LevenbergOptions levenberg = own_options(options, observations, start.size());
  levenberg.believable = [&](const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
    return turned_little(parameters, from, to);
  };
  levenberg.slope = [&](const Eigen::VectorXd& x) { return problem.slope(x); };
  levenberg.bend = [&](const Eigen::VectorXd& x, const Eigen::VectorXd& step) {
    return problem.bend(x, step);
  };
  return minimise(
      start, [&](const Eigen::VectorXd& x) { return problem.equations(x); },
      [&](const Eigen::VectorXd& x) { return problem.cost(x); }, levenberg);
}

}  // namespace

std::vector<std::string> runs_of_fit_rows(const Measurement& m) {
  std::vector<char> seen(m.states.run_names.size(), 0);
  for (const Observation& o : m.observations)
    if (m.check[o.row] == 0) seen[m.states.run[o.row]] = 1;
  std::vector<std::string> runs;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (seen[i] != 0) runs.push_back(m.states.run_names[i]);
  return runs;
}

bool matches_pattern(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern.front() == '*')
    return matches_pattern(pattern.substr(1), name) ||
           (!name.empty() && matches_pattern(pattern, name.substr(1)));
  return !name.empty() && (pattern.front() == '?' || pattern.front() == name.front()) &&
         matches_pattern(pattern.substr(1), name.substr(1));
}

Eigen::VectorXd align_set_ups(const Machine& machine, const Measurement& rows, const ParameterSet& all,
                              const Eigen::VectorXd& start) {
  Machine rigid = machine;
  for (Static& item : rigid.statics) item.hidden = true;
  for (Table& table : rigid.tables) table.free.fill(false);
  const ParameterSet shifts(rigid, runs_of_fit_rows(rows));
  if (shifts.size() == 0 || shifts.size() == all.size()) return start;
  const FitProblem problem(rigid, rows, shifts);
  const Eigen::VectorXd from = shifts.get(rigid);
  if (!(first_turn_deg(problem, shifts, from) > kTurned_deg)) return start;
  LevenbergOptions options;
  options.negligible = [](double cost) { return 1e-3 * cost; };
  options.slope = [&](const Eigen::VectorXd& x) { return problem.slope(x); };
  shifts.set(rigid, minimise(
                        from, [&](const Eigen::VectorXd& x) { return problem.equations(x); },
                        [&](const Eigen::VectorXd& x) { return problem.cost(x); }, options)
                        .point);
  return all.get(rigid);
}

Eigen::VectorXd solve(const FitProblem& problem, Eigen::VectorXd point, const FitOptions& options,
                      FitResult& result) {
  for (const auto& patterns : options.stages) {
    const LevenbergResult stage =
        solve_stage(problem, point, freed_in(patterns, result.parameters), options, result.before.count);
    point = stage.point;
    result.iterations += stage.iterations;
  }
  if (options.solver == Solver::kCeres || options.loss != Loss::kSquared) {
    if (!options.priors.empty()) throw InputError("priors go with the squared loss and the own solver");
    const CeresOutcome outcome = solve_with_ceres(problem, point, options);
    result.iterations += outcome.iterations;
    result.converged = outcome.converged;
    return outcome.point;
  }
  const LevenbergResult outcome = solve_all(problem, result.parameters, point, options, result.before.count);
  result.iterations += outcome.iterations;
  result.converged = outcome.converged;
  result.held = outcome.held;
  return outcome.point;
}

}  // namespace vernier
