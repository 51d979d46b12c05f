#include "tools/fit/problem.h"

#include <limits>

#include "tools/fit/statistics.h"

namespace vernier {

FitProblem::FitProblem(const Machine& machine, const Measurement& measurement, const ParameterSet& parameters)
    : machine_(machine),
      measurement_(measurement),
      parameters_(parameters),
      weights_(fit_weights(measurement)) {
  measured_.resize(weights_.size());
  for (std::size_t i = 0; i < measurement.observations.size(); ++i)
    measured_[static_cast<Eigen::Index>(i)] = measurement.observations[i].value;
}

Machine FitProblem::at(const Eigen::VectorXd& point) const {
  Machine machine = machine_;
  parameters_.set(machine, point);
  return machine;
}

double FitProblem::cost(const Eigen::VectorXd& point) const {
  try {
    return (measured_ - predict(at(point), measurement_)).cwiseProduct(weights_).squaredNorm();
  } catch (const InputError&) {
    return std::numeric_limits<double>::infinity();
  }
}

Eigen::VectorXd FitProblem::weighted_residuals(const Eigen::VectorXd& point, SparseRows* jacobian) const {
  if (jacobian == nullptr) return (measured_ - predict(at(point), measurement_)).cwiseProduct(weights_);
  Linearisation linear = linearise(at(point), measurement_, parameters_);
  *jacobian = weights_.asDiagonal() * linear.jacobian;
  return (measured_ - linear.predicted).cwiseProduct(weights_);
}

NormalEquations FitProblem::equations(const Eigen::VectorXd& point) const {
  SparseRows jacobian;
  const Eigen::VectorXd residual = weighted_residuals(point, &jacobian);
  NormalEquations result;
  result.cost = residual.squaredNorm();
  result.gradient = jacobian.transpose() * residual;
  const auto n = static_cast<Eigen::Index>(parameters_.size());
  result.normal = Eigen::MatrixXd::Zero(n, n);
  // Rows touch few parameters each; adding their outer products beats a sparse matrix product.
  for (Eigen::Index row = 0; row < jacobian.outerSize(); ++row)
    for (SparseRows::InnerIterator a(jacobian, row); a; ++a)
      for (SparseRows::InnerIterator b(jacobian, row); b && b.col() <= a.col(); ++b)
        result.normal(a.col(), b.col()) += a.value() * b.value();
  result.normal.triangularView<Eigen::StrictlyUpper>() = result.normal.transpose();
  return result;
}

}  // namespace vernier
