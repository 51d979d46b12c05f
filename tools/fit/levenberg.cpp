#include "tools/fit/levenberg.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace vernier {
namespace {

/// Relative fall of the cost below which a step brings nothing more.
constexpr double kCostTolerance = 1e-14;
constexpr double kFirstDamping = 1e-6;
constexpr double kMostDamping = 1e12;
constexpr double kMostBend = 0.75;

}  // namespace

LevenbergResult minimise(const Eigen::VectorXd& start,
                         const std::function<NormalEquations(const Eigen::VectorXd&)>& equations,
                         const std::function<double(const Eigen::VectorXd&)>& cost,
                         const LevenbergOptions& options) {
  LevenbergResult result;
  result.point = start;
  NormalEquations now = equations(start);
  result.cost = now.cost;
  if (start.size() == 0) {
    result.converged = true;
    return result;
  }
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(start.size());
  double damping = kFirstDamping, growth = 2;
  int quiet = 0;  // steps in a row that changed nothing
  for (int i = 0; i < options.max_iterations; ++i) {
    scale = scale.cwiseMax(now.normal.diagonal().cwiseSqrt());
    const Eigen::VectorXd shrink = scale.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
    const Eigen::MatrixXd scaled = shrink.asDiagonal() * now.normal * shrink.asDiagonal();
    const Eigen::VectorXd gradient = shrink.cwiseProduct(now.gradient);
    bool accepted = false;
    while (damping < kMostDamping) {
      Eigen::MatrixXd damped = scaled;
      damped.diagonal().array() += damping;
      const Eigen::LLT<Eigen::MatrixXd> factor(damped);
      const Eigen::VectorXd scaled_step = factor.solve(gradient);
      const double predicted = scaled_step.dot(gradient + damping * scaled_step);
      if (!std::isfinite(predicted) || predicted <= kCostTolerance * result.cost) {
        if (std::isfinite(predicted)) break;  // nothing left to gain
        damping *= growth;
        growth *= 2;
        continue;
      }
      Eigen::VectorXd bent = scaled_step;
      if (options.bend) {
        const Eigen::VectorXd bend = options.bend(result.point, shrink.cwiseProduct(scaled_step));
        const Eigen::VectorXd acceleration = -factor.solve(shrink.cwiseProduct(bend));
        // Beyond this the valley bends too sharply for two terms of its series.
        if (2 * acceleration.norm() <= kMostBend * scaled_step.norm()) bent += 0.5 * acceleration;
      }
      const Eigen::VectorXd next = result.point + shrink.cwiseProduct(bent);
      const double next_cost = cost(next);
      const double gain = (result.cost - next_cost) / predicted;
      if (std::isfinite(next_cost) && gain > 1e-4) {
        quiet = result.cost - next_cost <= options.negligible(next_cost) ? quiet + 1 : 0;
        result.point = next;
        result.cost = next_cost;
        damping =
            std::max(options.least_damping, damping * std::max(1.0 / 30, 1 - std::pow(2 * gain - 1, 3)));
        growth = 2;
        accepted = true;
        break;
      }
      damping = std::max(damping, options.least_damping) * growth;
      growth *= 2;
    }
    result.iterations = i + 1;
    if (options.progress) options.progress(result.iterations, result.cost);
    if (!accepted || quiet >= 2) {
      result.converged = damping < kMostDamping;
      return result;
    }
    now = equations(result.point);
  }
  return result;
}

}  // namespace vernier
