// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/least_squares/levenberg.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/maths/pivoted_cholesky.h"

namespace vernier::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Relative decrease of the cost below which a step is negligible.
constexpr double kCostTolerance = 1e-14;
constexpr double kFirstDamping = 1e-6, kLeastDamping = 1e-8, kMostDamping = 1e12;
constexpr double kMostBend = 0.75;
/// Ratio of actual to predicted decrease above which the factor is used again.
constexpr double kTrue = 0.9;
/// A new factor is computed if a chord step leaves more than this share of the previous possible
/// decrease.
constexpr double kSlowChord = 0.1;
class Minimiser {
 public:
  Minimiser(const VectorXd& start, const std::function<NormalEquations(const VectorXd&)>& equations,
            const std::function<double(const VectorXd&)>& cost, const LevenbergOptions& options)
      : equations_(equations), cost_(cost), options_(options) {
    result_.point = start;
    scale_ = VectorXd::Zero(start.size());
  }

  LevenbergResult run() {
    descend();
    return result_;
  }

 private:
  enum class Step : std::uint8_t { kGood, kPoor, kNothingLeft, kFailed };

  void descend();
  void prepare();
  void factorise();
  Step step();
  Step chord();
  VectorXd bent(const VectorXd& straight) const;
  Slope look(const VectorXd& point) const;
  VectorXd solve(const VectorXd& gradient) const;
  void accept(const VectorXd& point, const Slope& slope);

  const std::function<NormalEquations(const VectorXd&)>& equations_;
  const std::function<double(const VectorXd&)>& cost_;
  const LevenbergOptions& options_;
  LevenbergResult result_;
  VectorXd scale_, shrink_, gradient_;  // gradient_: of the current point, scaled
  MatrixXd scaled_;                     // normal matrix with unit diagonal
  std::optional<maths::PivotedCholesky> factor_;
  MatrixXd unseen_;  // orthonormal; scaled
  double damping_ = 0, growth_ = 2, promised_ = 0;
  bool troubled_ = false;  // the last step decreased the cost less than predicted
  int quiet_ = 0;          // successive steps without a change
};

/// The normal equations at the current point, scaled.
void Minimiser::prepare() {
  const NormalEquations now = equations_(result_.point);
  result_.cost = now.cost;
  scale_ = scale_.cwiseMax(now.normal.diagonal().cwiseSqrt());
  shrink_ = scale_.unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
  scaled_ = shrink_.asDiagonal() * now.normal * shrink_.asDiagonal();
  gradient_ = shrink_.cwiseProduct(now.gradient);
}

/// The unseen directions are selected once, at the start. Directions that are less visible later
/// are added.
void Minimiser::factorise() {
  MatrixXd damped = scaled_;
  damped.diagonal().array() += damping_;
  factor_.emplace(std::move(damped), options_.unseen, result_.held);
  if (result_.held.empty()) result_.held = factor_->left_over();
  unseen_ = factor_->null_basis();
}

/// Returns the shortest of the steps that the kept rows cannot distinguish.
VectorXd Minimiser::solve(const VectorXd& gradient) const {
  VectorXd step = factor_->solve(gradient);
  if (unseen_.cols() > 0) step -= unseen_ * (unseen_.transpose() * step);
  return step;
}

VectorXd Minimiser::bent(const VectorXd& straight) const {
  if (!options_.bend || !troubled_) return straight;
  const VectorXd bend = options_.bend(result_.point, shrink_.cwiseProduct(straight));
  const VectorXd acceleration = -solve(shrink_.cwiseProduct(bend));
  // Beyond this limit the valley bends too sharply for two terms of its series.
  if (2 * acceleration.norm() > kMostBend * straight.norm()) return straight;
  return straight + 0.5 * acceleration;
}

Slope Minimiser::look(const VectorXd& point) const {
  if (options_.slope) return options_.slope(point);
  return {cost_(point), {}};
}

void Minimiser::accept(const VectorXd& point, const Slope& slope) {
  quiet_ = result_.cost - slope.cost <= options_.negligible(slope.cost) ? quiet_ + 1 : 0;
  result_.point = point;
  result_.cost = slope.cost;
  if (slope.gradient.size() > 0) gradient_ = shrink_.cwiseProduct(slope.gradient);
  ++result_.iterations;
  if (options_.progress) options_.progress(result_.iterations, result_.cost);
}

/// Makes one step with a new factor, damped until it lowers the cost.
Minimiser::Step Minimiser::step() {
  while (damping_ < kMostDamping) {
    factorise();
    const VectorXd straight = solve(gradient_);
    promised_ = straight.dot(gradient_ + damping_ * straight);
    if (std::isfinite(promised_) && promised_ <= kCostTolerance * result_.cost) return Step::kNothingLeft;
    if (std::isfinite(promised_)) {
      const VectorXd next = result_.point + shrink_.cwiseProduct(bent(straight));
      Slope there = look(next);
      const double gain = (result_.cost - there.cost) / promised_;
      if (std::isfinite(there.cost) && gain > 1e-4) {
        accept(next, there);
        damping_ *= std::max(1.0 / 30, 1 - std::pow(2 * gain - 1, 3));
        if (damping_ < kLeastDamping) damping_ = 0;
        growth_ = 2;
        troubled_ = gain < 0.5;
        return gain > kTrue ? Step::kGood : Step::kPoor;
      }
    }
    troubled_ = true;
    damping_ = damping_ > 0 ? damping_ * growth_ : kFirstDamping;
    growth_ *= 2;
  }
  return Step::kFailed;
}

/// Makes a step with the factor of an earlier point and the gradient of this point.
Minimiser::Step Minimiser::chord() {
  const VectorXd straight = solve(gradient_);
  const double before = promised_;
  promised_ = straight.dot(gradient_);
  if (!(promised_ > options_.negligible(result_.cost) / 10)) return Step::kNothingLeft;
  if (promised_ > kSlowChord * before) return Step::kPoor;
  const VectorXd next = result_.point + shrink_.cwiseProduct(straight);
  Slope there = look(next);
  if (!std::isfinite(there.cost) || result_.cost - there.cost < 0.5 * promised_) return Step::kPoor;
  accept(next, there);
  return Step::kGood;
}

void Minimiser::descend() {
  result_.converged = false;
  quiet_ = 0;
  prepare();
  while (result_.iterations < options_.max_iterations) {
    Step done = step();
    const bool undamped = damping_ == 0;
    while (done == Step::kGood && undamped && options_.slope && result_.iterations < options_.max_iterations)
      done = chord();
    if (done == Step::kFailed) return;
    if (done == Step::kNothingLeft || quiet_ >= 2) {
      result_.converged = true;
      return;
    }
    prepare();
  }
}

}  // namespace

LevenbergResult minimise(const VectorXd& start,
                         const std::function<NormalEquations(const VectorXd&)>& equations,
                         const std::function<double(const VectorXd&)>& cost,
                         const LevenbergOptions& options) {
  return Minimiser(start, equations, cost, options).run();
}

}  // namespace vernier::fit
