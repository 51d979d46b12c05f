// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/settle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "tools/fit/convention.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/noise/noise_estimate.h"
#include "tools/fit/seen_errors.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/inverse.h"
#include "tools/maths/orthonormal.h"

namespace vernier::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

// Largest number of alternations of scales and noise; fewer if each needs seconds.
constexpr int kRounds = 6, kRoundsOfMany = 2;
constexpr Index kMany = 400;    // above it an inverse needs a tenth of a second and more
constexpr int kMostSteps = 12;  // of Gauss and Newton, at most
/// Number of times that the penalty is applied: iterated Tikhonov regularisation (Engl, Hanke,
/// Neubauer, Regularization of inverse problems, 1996, section 5.1). A direction known to share r
/// of its scale is moved by r^(2 n - 1).
constexpr int kPasses = 3;
/// A step below this share of every parameter's standard deviation is zero (squared, in the cost's
/// metric).
constexpr double kSettled = 1e-14;
/// Below this share the result counts as converged.
constexpr double kConverged = 1e-6;
/// Damping of a step, relative to the diagonal of the normal matrix.
constexpr double kSettleFirstDamping = 1e-9, kSettleTimesDamping = 10, kSettleMostDamping = 1e3;
/// A damped step that lowers the cost by less than this share of the variance of a reading is the last one
/// (solve.cpp has the same limit).
constexpr double kLastDecrease = 1e-3;
/// Lower limit of the noise as a share of the residual of the nominal machine. Below it the
/// convention would be lost in rounding (readings written with six decimals, simulations without
/// noise).
constexpr double kLeastNoise = 1e-3;

/// Cholesky, and its form for matrices that rounding made indefinite.
MatrixXd solve_scaled(const MatrixXd& matrix, const MatrixXd& right) {
  const Eigen::LLT<MatrixXd> llt(matrix);
  if (llt.info() == Eigen::Success) return llt.solve(right);
  return maths::solve_symmetric(matrix, right);
}

/// Symmetric inverse of a positive definite matrix of unequal scales.
MatrixXd inverse_of(const MatrixXd& matrix) {
  const VectorXd shrink = matrix.diagonal().cwiseSqrt().cwiseInverse();
  MatrixXd scaled = shrink.asDiagonal() * matrix * shrink.asDiagonal();
  if (matrix.rows() > kMany)
    if (const std::optional<MatrixXd> inverse = maths::inverse_of_positive(scaled))
      return shrink.asDiagonal() * *inverse * shrink.asDiagonal();
  const MatrixXd inverse = solve_scaled(scaled, MatrixXd::Identity(matrix.rows(), matrix.cols()));
  return shrink.asDiagonal() * (0.5 * (inverse + inverse.transpose())) * shrink.asDiagonal();
}

VectorXd solution_of(const MatrixXd& matrix, const VectorXd& right) {
  const VectorXd shrink = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const MatrixXd scaled = shrink.asDiagonal() * matrix * shrink.asDiagonal();
  return shrink.cwiseProduct(solve_scaled(scaled, shrink.cwiseProduct(right)).col(0));
}

class Settler {
 public:
  Settler(FitProblem& problem, const Convention& convention, const StatedPriors& stated,
          std::size_t observations, bool with_u, const std::optional<NoiseModel>& noise, bool of_files)
      : problem_(problem),
        of_files_(of_files),
        noise_(noise),
        convention_(convention),
        stated_(stated),
        observations_(static_cast<double>(observations)),
        with_u_(with_u),
        mean_weight_(problem.weights().squaredNorm() / std::max(1.0, observations_)),
        scale_(convention.scale) {
    problem_.clear_priors();
  }

  Settled describe(const VectorXd& point) {
    result_.point = point;
    linearise();
    result_.variance = first_variance();
    finish();
    return std::move(result_);
  }

  Settled run(const VectorXd& start) {
    result_.point = start;
    linearise();
    result_.variance = first_variance();
    const int rounds = start.size() > kMany ? kRoundsOfMany : kRounds;
    for (int round = 0; round < rounds; ++round) adapt();
    // The quadratic model is good near its own minimum. Scales and noise are computed once more
    // from there.
    step_to(convention_.centre);
    for (int round = 0; round < rounds; ++round) adapt();
    descend(convention_.centre);
    for (int pass = 1; pass < kPasses; ++pass) descend(result_.point);
    finish();
    return std::move(result_);
  }

 private:
  Sparse weak() const {
    return std::max(result_.variance, floor_of_variance()) * scaled_precision(convention_, scale_);
  }
  double stated_unit() const { return with_u_ ? 1 : std::max(result_.variance, floor_of_variance()); }

  /// Computes the readings' quadratic model at this point.
  void linearise() {
    const NormalEquations now = problem_.equations(result_.point);
    result_.chi_square = now.cost;
    readings_ = now.normal;
    gradient_ = now.gradient;
    ++result_.iterations;
  }

  /// In the unit of the cost: squares of weighted readings.
  double floor_of_variance() const {
    return std::pow(kLeastNoise * convention_.misfit_mm, 2) * mean_weight_ + 1e-300;
  }

  double first_variance() const {
    if (with_u_) return 1;
    return std::max(result_.chi_square / observations_, 1e-300);
  }

  /// Adapts scales and noise to the quadratic model, one round.
  void adapt() {
    const Sparse weak_now = weak();
    MatrixXd all = readings_ + weak_now;
    all.diagonal() += stated_unit() * stated_.weight;
    const MatrixXd inverse = inverse_of(all);
    const VectorXd step =
        inverse * (gradient_ + weak_now * (convention_.centre - result_.point) +
                   stated_unit() * stated_.weight.cwiseProduct(stated_.centre - result_.point));
    const VectorXd value = result_.point + step;
    const VectorXd from_data = VectorXd::Ones(value.size()) - (inverse * weak_now).diagonal();
    const VectorXd off = (value - convention_.centre).cwiseQuotient(scale_);
    const VectorXd squares = off.cwiseProduct(convention_.precision * off);
    const double chi_square =
        std::max(0.0, result_.chi_square - 2 * step.dot(gradient_) + step.dot(readings_ * step));
    const double freedom = observations_ - from_data.sum();
    if (freedom > 0.5) {
      const double reduced = chi_square / freedom;
      result_.variance = with_u_ ? std::max(1.0, reduced) : std::max(reduced, 1e-300);
    }
    const VectorXd shares = scale_.cwiseQuotient(convention_.scale).cwiseAbs2();
    const SeenErrors sizes(convention_, shares.cwiseProduct(squares), from_data,
                           readings_.diagonal().cwiseProduct(convention_.scale.cwiseAbs2()));
    for (Index i = 0; i < value.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (sizes.seen(convention_.kind[at]))
        scale_[i] =
            convention_.scale[i] * std::sqrt(sizes.variance(convention_.kind[at], convention_.table[at]));
      if (convention_.kind[at] >= Convention::kFirstOfStatics)
        scale_[i] =
            std::max(scale_[i], beyond(convention_.scale[i], value[i] - convention_.centre[i], from_data[i]));
      if (convention_.most.size() > 0) scale_[i] = std::min(scale_[i], convention_.most[i]);
    }
  }

  /// Returns the scale of a static if the readings give a value beyond the convention's scale by
  /// three standard deviations of both, else 0. An error that set-ups hide almost completely is
  /// larger than the residual of the nominal machine. `off`: from the centre.
  static double beyond(double scale, double off, double from_data) {
    constexpr double kTimes = 3, kUnseen = 1e-6;  // below that share `off` is rounding
    if (from_data < kUnseen) return 0;
    const double expected = std::abs(off) / std::sqrt(from_data);  // evidence, MacKay 1992
    return expected > kTimes * scale ? expected : 0;
  }

  MatrixXd normal_with_priors() const {
    MatrixXd all = readings_ + weak();
    all.diagonal() += stated_unit() * stated_.weight;
    return all;
  }

  VectorXd gradient_with_priors(const VectorXd& centre) const {
    return gradient_ + weak() * (centre - result_.point) +
           stated_unit() * stated_.weight.cwiseProduct(stated_.centre - result_.point);
  }

  double cost(const VectorXd& centre) const {
    const VectorXd off = result_.point - centre;
    return result_.chi_square + off.dot(weak() * off) +
           stated_unit() * stated_.weight.dot((result_.point - stated_.centre).cwiseAbs2());
  }

  /// Makes one Gauss-Newton step. If the step raises the cost, it is damped (Levenberg) until it does not:
  /// along a direction that the readings show only in second order, the quadratic model is far too flat.
  /// Returns the size of the step in standard deviations, squared.
  double step_to(const VectorXd& centre) {
    const VectorXd gradient = gradient_with_priors(centre), from = result_.point;
    const MatrixXd normal = normal_with_priors();
    const double unit = std::max(result_.variance, floor_of_variance()), before = cost(centre);
    const auto next = [](double damping) {
      return std::max(kSettleFirstDamping, kSettleTimesDamping * damping);
    };
    for (double damping = 0; damping < kSettleMostDamping; damping = next(damping)) {
      MatrixXd damped = normal;
      damped.diagonal() *= 1 + damping;
      const VectorXd step = solution_of(damped, gradient);
      if (damping == 0) result_.last_step = step.cwiseQuotient(scale_);
      result_.point = from + step;
      try {
        linearise();
      } catch (const text::InputError&) {
        continue;  // the model is undefined there
      }
      const double after = cost(centre);
      // A millionth of a reading's variance is the rounding error of a large sum.
      if (!(after <= before + 1e-6 * result_.variance + 1e-9 * before)) continue;
      if (damping == 0) return step.dot(gradient) / unit;
      return before - after < kLastDecrease * unit ? 0 : (before - after) / unit;
    }
    result_.point = from;
    linearise();
    return std::numeric_limits<double>::infinity();
  }

  void descend(const VectorXd& centre) {
    double last = std::numeric_limits<double>::infinity();
    const VectorXd fixed = centre;  // NOLINT: a copy, because it may be result_.point itself
    for (int i = 0; i < kMostSteps; ++i) {
      const double size = step_to(fixed);
      result_.converged = std::isfinite(size) && size < kConverged;
      if (!(size > kSettled) || (i > 2 && !(size < last))) return;
      last = size;
    }
  }

  void finish() {
    result_.scale = scale_;
    MatrixXd data = readings_;
    data.diagonal() += stated_unit() * stated_.weight;
    const Sparse weak_now = weak();
    const MatrixXd inverse = inverse_of(data + weak_now);
    // Remaining part of a true value: (inverse * weak)^n, and the contribution of a reading. Each
    // inverse * weak * inverse * ... is symmetric, and weak is sparse.
    MatrixXd power = inverse, gain = inverse;
    for (int pass = 1; pass < kPasses; ++pass) {
      power = maths::symmetric_product(power * weak_now, inverse);
      gain += power;
    }
    const MatrixXd left = power * weak_now;
    const double fitted = static_cast<double>(left.rows()) - left.cwiseProduct(left.transpose()).sum();
    result_.freedom = observations_ - fitted;
    if (result_.freedom > 0.5) {
      const double reduced = result_.chi_square / result_.freedom;
      result_.variance = with_u_ ? std::max(1.0, reduced) : std::max(reduced, 1e-300);
    }
    const Sparse spread = scale_.asDiagonal() * convention_.correlation * scale_.asDiagonal();
    const MatrixXd bias = maths::symmetric_product(left * spread, left.transpose());
    result_.bias = bias.diagonal().cwiseMax(0).cwiseSqrt();
    result_.covariance = covariance_from_readings(data, gain, left) + bias;
    result_.open = bias;
    result_.normal = std::move(data);
  }

  /// Orthonormal directions of the readings that the touched objects and the parameters can follow. A
  /// direction of the parameters that moves the readings, at the scale of its parameters and beside the
  /// objects, by a small part of the standard deviation of one reading is no direction. Where the objects
  /// follow a parameter, only a linear map of the residuals is left of it: such directions can reproduce
  /// every residual.
  MatrixXd fitted_directions(const MatrixXd& jacobian, const MatrixXd& of_things, double size) const {
    constexpr double kRoundingOfResidual = 1e-6;  // of the residual
    constexpr double kOfResidual = 4;             // of the residual, at the scale of the parameters
    MatrixXd moved = jacobian * scale_.asDiagonal();
    if (of_things.cols() == 0) {
      for (Eigen::Index k = 0; k < moved.cols(); ++k)
        if (!(moved.col(k).norm() > kRoundingOfResidual * size)) moved.col(k).setZero();
      return maths::orthonormal(moved, kRoundingOfResidual, nullptr);
    }
    const MatrixXd followed = maths::orthonormal(of_things, kRoundingOfResidual, nullptr);
    moved -= followed * (followed.transpose() * moved);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> parts(moved.transpose() * moved);
    const double least = kOfResidual * size;
    std::vector<Eigen::Index> kept;
    for (Eigen::Index k = 0; k < moved.cols(); ++k)
      if (parts.eigenvalues()[k] > least * least) kept.push_back(k);
    MatrixXd columns(moved.rows(), followed.cols() + static_cast<Eigen::Index>(kept.size()));
    columns << followed, moved * parts.eigenvectors()(Eigen::all, kept);
    return maths::orthonormal(columns, kRoundingOfResidual, nullptr);
  }

  double unknowns_of_things() const {
    double count = 0;
    for (std::size_t k = 0; k < problem_.things().clusters(); ++k)
      count += static_cast<double>(problem_.things().unknowns(k));
    return count;
  }

  /// Returns gain * J^T W cov(readings) W J * gain^T. For independent errors the middle is `variance` times
  /// `data`, and gain * data = I - left, because the inverse of data + weak times data is I - once.
  MatrixXd covariance_from_readings(const MatrixXd& data, const MatrixXd& gain, const MatrixXd& left) {
    const std::optional<MatrixXd> correlated = readings_covariance(data);
    if (correlated && !of_files_) return gain * *correlated * gain.transpose();
    const MatrixXd independent = result_.variance * (gain - maths::symmetric_product(gain, left.transpose()));
    if (!correlated) return independent;
    // The correlation can be that of one file, which the model describes badly. It must not make an estimate
    // from another file more certain.
    const MatrixXd common = gain * *correlated * gain.transpose();
    VectorXd larger = VectorXd::Ones(common.rows());
    for (Index i = 0; i < larger.size(); ++i)
      if (common(i, i) > 0) larger[i] = std::sqrt(std::max(1.0, independent(i, i) / common(i, i)));
    return larger.asDiagonal() * common * larger.asDiagonal();
  }

  /// Returns J^T W cov(readings) W J if the errors are correlated: their influence on a fit that assumed
  /// independence (White 1980). Returns nullopt if they are independent: then it is `variance` times the
  /// normal matrix.
  std::optional<MatrixXd> readings_covariance(const MatrixXd& data) {
    constexpr double kMostNumbers =
        5e7;  // 400 MB of numbers: beyond this limit, rows are taken as independent
    const model::Measurement& rows = problem_.measurement();
    const VectorXd& weights = problem_.weights();
    const std::vector<std::size_t> fitted = fitted_readings(weights);
    const double n = static_cast<double>(fitted.size()), p = static_cast<double>(data.cols());
    const bool given_independent = noise_ && noise_->independent();
    if (given_independent || n * p > kMostNumbers || p < 1) {
      if (noise_) result_.noise = *noise_;
      return std::nullopt;
    }
    model::SparseRows jacobian;
    const VectorXd residual = problem_.weighted_residuals(result_.point, &jacobian)(fitted);
    // As many numbers as readings times parameters: only where they are needed.
    const auto dense = [&]() -> MatrixXd { return MatrixXd(jacobian)(fitted, Eigen::all); };
    const NoiseLayout layout = noise_layout(rows, fitted);
    if (noise_) {
      result_.noise = *noise_;
    } else {
      MatrixXd basis(residual.size(), 0);
      const double unknowns = unknowns_of_things();
      const bool whole = unknowns > 0 && n * std::pow(p + unknowns, 2) < kMostNoiseProducts;
      MatrixXd of_things(residual.size(), 0);
      if (whole) of_things = problem_.things_jacobian(result_.point)(fitted, Eigen::all);
      if (whole || n * p * p < kMostNoiseProducts)
        basis = fitted_directions(dense(), of_things, residual.norm());
      // The scales leave a part of the fitted directions in the residual, which is no noise.
      VectorXd beside = residual;
      if (basis.cols() > 0) beside -= basis * (basis.transpose() * residual);
      result_.noise = estimate_noise(layout, beside, basis, with_u_);
    }
    if (result_.noise.independent()) return std::nullopt;
    const MatrixXd j = dense();
    MatrixXd hanging = j.transpose() * covariance_times(layout, result_.noise, j);
    hanging.diagonal() += stated_unit() * stated_.weight;
    if (const MatrixXd known = problem_.known_normal(result_.point); known.size() > 0) hanging += known;
    return hanging;
  }

  FitProblem& problem_;
  const bool of_files_;
  const std::optional<NoiseModel>& noise_;
  const Convention& convention_;
  const StatedPriors& stated_;
  const double observations_;
  const bool with_u_;
  const double mean_weight_;  // of the readings, squared: 1 / u^2
  VectorXd scale_;
  Settled result_;
  MatrixXd readings_;
  VectorXd gradient_;
};

}  // namespace

Settled settle(FitProblem& problem, const VectorXd& point, const Convention& convention,
               const StatedPriors& stated, std::size_t observations, bool with_u,
               const std::optional<NoiseModel>& noise, bool of_files) {
  return Settler(problem, convention, stated, observations, with_u, noise, of_files).run(point);
}

Settled describe(FitProblem& problem, const VectorXd& point, const Convention& convention,
                 const StatedPriors& stated, std::size_t observations, bool with_u,
                 const std::optional<NoiseModel>& noise) {
  return Settler(problem, convention, stated, observations, with_u, noise, false).describe(point);
}

}  // namespace vernier::fit
