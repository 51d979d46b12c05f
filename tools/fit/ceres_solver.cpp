// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/ceres_solver.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

#include "tools/maths/decompositions.h"
#include "tools/maths/median.h"

namespace vernier::fit {
namespace {

/// Evaluates all rows once per point. The residual blocks read their line of the result.
class WholeEvaluation : public ceres::EvaluationCallback {
 public:
  WholeEvaluation(const FitProblem& problem, const Eigen::VectorXd& values)
      : problem_(problem), values_(values) {}
  void PrepareForEvaluation(bool jacobians, bool new_point) override {
    if (new_point || (jacobians && !has_jacobian_)) {
      valid_ = true;
      try {
        residual_ = problem_.weighted_residuals(values_, jacobians ? &jacobian_ : nullptr);
      } catch (const text::InputError&) {
        valid_ = false;
      }
      has_jacobian_ = jacobians && valid_;
    }
  }
  bool valid() const { return valid_; }
  double residual(Eigen::Index row) const { return residual_[row]; }
  const model::SparseRows& jacobian() const { return jacobian_; }

 private:
  const FitProblem& problem_;
  const Eigen::VectorXd& values_;
  Eigen::VectorXd residual_;
  model::SparseRows jacobian_;
  bool has_jacobian_ = false, valid_ = true;
};

class OneObservation : public ceres::CostFunction {
 public:
  OneObservation(const WholeEvaluation& all, Eigen::Index row, std::vector<int> columns)
      : all_(all), row_(row), columns_(std::move(columns)) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(columns_.size(), 1);
  }
  bool Evaluate(double const* const* /*values*/, double* residuals, double** jacobians) const override {
    if (!all_.valid()) return false;
    residuals[0] = all_.residual(row_);
    if (jacobians == nullptr) return true;
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (jacobians[i] != nullptr) jacobians[i][0] = -all_.jacobian().coeff(row_, columns_[i]);
    return true;
  }

 private:
  const WholeEvaluation& all_;
  Eigen::Index row_;
  std::vector<int> columns_;
};

/// A row of L^T (value - centre), L L^T the precision of the priors.
class HeldNear : public ceres::CostFunction {
 public:
  HeldNear(std::vector<double> factor, std::vector<double> centre)
      : factor_(std::move(factor)), centre_(std::move(centre)) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(factor_.size(), 1);
  }
  bool Evaluate(double const* const* values, double* residuals, double** jacobians) const override {
    residuals[0] = 0;
    for (std::size_t i = 0; i < factor_.size(); ++i) {
      residuals[0] += factor_[i] * (values[i][0] - centre_[i]);
      if (jacobians != nullptr && jacobians[i] != nullptr) jacobians[i][0] = factor_[i];
    }
    return true;
  }

 private:
  std::vector<double> factor_, centre_;
};

void add_priors(const FitProblem& problem, Eigen::VectorXd& point, ceres::Problem& to) {
  const Eigen::VectorXd& centre = problem.prior_centre();
  if (centre.size() == 0) return;
  const Eigen::MatrixXd lower = Eigen::MatrixXd(problem.prior_precision()).llt().matrixL();
  for (Eigen::Index column = 0; column < lower.cols(); ++column) {
    std::vector<double> factor, near;
    std::vector<double*> blocks;
    for (Eigen::Index row = column; row < lower.rows(); ++row) {
      if (lower(row, column) == 0) continue;
      factor.push_back(lower(row, column));
      near.push_back(centre[row]);
      blocks.push_back(point.data() + row);
    }
    to.AddResidualBlock(new HeldNear(std::move(factor), std::move(near)), nullptr, blocks);
  }
}

double spread(const Eigen::VectorXd& residual) {
  return residual.size() == 0 ? 1 : maths::robust_spread({residual.begin(), residual.end()});
}

ceres::LossFunction* loss_of(Loss loss, double scale) {
  if (loss == Loss::kHuber) return new ceres::HuberLoss(scale);
  if (loss == Loss::kCauchy) return new ceres::CauchyLoss(scale);
  return nullptr;
}

CeresOutcome solve_once(const FitProblem& problem, const Eigen::VectorXd& start, const FitOptions& options,
                        double scale) {
  CeresOutcome outcome;
  outcome.scale = scale;
  outcome.point = start;
  if (start.size() == 0) {
    outcome.converged = true;
    return outcome;
  }
  WholeEvaluation all(problem, outcome.point);
  ceres::Problem::Options ceres_options;
  ceres_options.evaluation_callback = &all;
  ceres::Problem ceres_problem(ceres_options);
  model::SparseRows jacobian;
  problem.weighted_residuals(start, &jacobian);
  for (Eigen::Index i = 0; i < start.size(); ++i)
    ceres_problem.AddParameterBlock(outcome.point.data() + i, 1);
  for (Eigen::Index row = 0; row < jacobian.outerSize(); ++row) {
    if (problem.measurement().check[problem.measurement().observations[static_cast<std::size_t>(row)].row] !=
        0)
      continue;
    std::vector<int> columns;
    std::vector<double*> blocks;
    for (model::SparseRows::InnerIterator entry(jacobian, row); entry; ++entry) {
      columns.push_back(static_cast<int>(entry.col()));
      blocks.push_back(outcome.point.data() + entry.col());
    }
    if (columns.empty()) continue;
    ceres_problem.AddResidualBlock(new OneObservation(all, row, std::move(columns)),
                                   loss_of(options.loss, scale), blocks);
  }
  add_priors(problem, outcome.point, ceres_problem);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.initial_trust_region_radius = 1e8;
  solver.max_num_iterations = options.max_iterations;
  // An outlier dominates the cost. The last digits of the others are then a millionth of it and
  // less.
  solver.function_tolerance = options.loss == Loss::kSquared ? 1e-14 : 1e-11;
  solver.parameter_tolerance = 1e-14;
  solver.gradient_tolerance = 1e-16;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &ceres_problem, &summary);
  outcome.iterations = static_cast<int>(summary.iterations.size());
  outcome.converged = summary.termination_type == ceres::CONVERGENCE;
  return outcome;
}

}  // namespace

Eigen::VectorXd robust_shares(const Eigen::VectorXd& residual, Loss loss, double scale) {
  Eigen::VectorXd shares = Eigen::VectorXd::Ones(residual.size());
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    const double size = std::abs(residual[i]) / scale;
    if (loss == Loss::kHuber) shares[i] = size > 1 ? 1 / size : 1;
    if (loss == Loss::kCauchy) shares[i] = 1 / (1 + size * size);
  }
  return shares;
}

CeresOutcome solve_with_ceres(const FitProblem& problem, const Eigen::VectorXd& start,
                              const FitOptions& options) {
  if (options.loss == Loss::kSquared) return solve_once(problem, start, options, 1);
  if (has_uncertainty(problem.measurement())) return solve_once(problem, start, options, options.loss_scale);
  // Without u the scale is the residual's own standard deviation. It needs a first fit. A second
  // fit improves it.
  FitOptions plain = options;
  plain.loss = Loss::kSquared;
  CeresOutcome outcome = solve_once(problem, start, plain, 1);
  for (int pass = 0; pass < 2; ++pass) {
    const double width = spread(problem.weighted_residuals(outcome.point, nullptr));
    outcome = solve_once(problem, outcome.point, options, options.loss_scale * std::max(width, 1e-12));
  }
  return outcome;
}

}  // namespace vernier::fit
