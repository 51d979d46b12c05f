// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/touch_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/maths/chance.h"
#include "tools/maths/decompositions.h"
#include "tools/text/error.h"

namespace vernier::probe {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostSteps = 100;  // of Gauss-Newton, at most
// Step of a parameter for a difference; relative change of the cost at the end; share of the
// largest singular value.
constexpr double kStepRelative = 1e-6, kConverged = 1e-12, kSingular = 1e-9;

MatrixXd jacobian(const TouchModel& model, const VectorXd& at) {
  MatrixXd j;
  for (Index k = 0; k < at.size(); ++k) {
    const double h = kStepRelative * std::max(1.0, std::abs(at(k)));
    VectorXd up = at, down = at;
    up(k) += h, down(k) -= h;
    const VectorXd column = (model(up) - model(down)) / (2 * h);
    if (k == 0) j.resize(column.size(), at.size());
    j.col(k) = column;
  }
  return j;
}

/// Result of one pass over the kept touches.
struct Pass {
  VectorXd value, residual;
  MatrixXd j;  // weighted, rows of outliers zero
  Eigen::JacobiSVD<MatrixXd> svd;
  VectorXd scale;
};

class TouchSolver {
 public:
  TouchSolver(const TouchModel& model, const TouchFitOptions& options, const std::vector<std::string>& names)
      : model_(model), options_(options), names_(names) {}

  Pass solve(VectorXd at, const std::vector<bool>& kept) const {
    Pass pass;
    VectorXd weight = weights(model_(at).size(), kept);
    double before = (weight.array() * model_(at).array()).square().sum();
    for (int step = 0; step < kMostSteps; ++step) {
      decompose(pass, at, weight);
      const VectorXd r = weight.array() * model_(at).array();
      VectorXd move = -(pass.svd.solve(r).array() / pass.scale.array()).matrix();
      double after = before;
      for (int half = 0; half < 30; ++half, move /= 2) {
        after = (weight.array() * model_(at + move).array()).square().sum();
        if (after <= before) break;
      }
      if (after > before) break;
      at += move;
      const bool still = (move.array() * pass.scale.array()).matrix().norm() < 1e-10 * (1 + std::sqrt(after));
      if (still || before - after <= kConverged * before) {
        before = after;
        break;
      }
      before = after;
    }
    decompose(pass, at, weight);
    pass.value = at;
    pass.residual = model_(at);
    return pass;
  }

  VectorXd weights(Index size, const std::vector<bool>& kept) const {
    VectorXd w(size);
    for (Index i = 0; i < size; ++i)
      w(i) = !kept[static_cast<std::size_t>(i) / options_.per_touch] ? 0
             : options_.u                                            ? 1 / (*options_.u)(i)
                                                                     : 1;
    return w;
  }

 private:
  void decompose(Pass& pass, const VectorXd& at, const VectorXd& weight) const {
    pass.j = weight.asDiagonal() * jacobian(model_, at);
    pass.scale = pass.j.colwise().norm().transpose();
    for (Index k = 0; k < pass.scale.size(); ++k)
      if (pass.scale(k) == 0)
        throw text::InputError(
            fmt::format("the touches do not determine {}", names_[static_cast<std::size_t>(k)]));
    pass.svd.compute(pass.j * pass.scale.cwiseInverse().asDiagonal(),
                     Eigen::ComputeThinU | Eigen::ComputeThinV);
    const VectorXd& s = pass.svd.singularValues();
    if (s(s.size() - 1) > kSingular * s(0)) return;
    std::string weak;
    for (Index k = 0; k < at.size(); ++k)
      if (std::abs(pass.svd.matrixV()(k, at.size() - 1)) > 0.3)
        weak += (weak.empty() ? "" : ", ") + names_[static_cast<std::size_t>(k)];
    throw text::InputError("the touches do not distinguish: " + weak);
  }

  const TouchModel& model_;
  const TouchFitOptions& options_;
  const std::vector<std::string>& names_;
};

double chi_square(const Pass& pass, const VectorXd& weight) {
  return (weight.array() * pass.residual.array()).square().sum();
}

// Returns the touch that is least consistent with the others, if its probability is below the
// level.
std::optional<TouchOutlier> worst(const Pass& pass, const VectorXd& weight, const TouchFitOptions& options,
                                  int n, int dof) {
  std::optional<TouchOutlier> found;
  if (dof < 3) return found;
  const double chi2 = chi_square(pass, weight);
  for (Index i = 0; i < pass.residual.size(); ++i) {
    if (weight(i) == 0) continue;
    const double leverage = std::min(pass.svd.matrixU().row(i).squaredNorm(), 1 - 1e-9);
    const double e = weight(i) * pass.residual(i);
    const double without = chi2 - e * e / (1 - leverage);
    if (without <= 0) continue;
    const double t = e / std::sqrt(without / (dof - 1) * (1 - leverage));
    // Two-sided: t^2 is F with 1 and dof - 1.
    const double p = std::min(1.0, n * std::exp(maths::log_f_tail(t * t, 1, dof - 1)));
    if (p < options.outlier_level && (!found || std::abs(t) > std::abs(found->t)))
      found = TouchOutlier{static_cast<std::size_t>(i) / options.per_touch, pass.residual(i), t, p};
  }
  return found;
}

}  // namespace

TouchFit fit_touches(const TouchModel& model, const VectorXd& start, const TouchFitOptions& options,
                     const std::vector<std::string>& names) {
  const Index observations = model(start).size();
  const std::size_t touches = static_cast<std::size_t>(observations) / options.per_touch;
  TouchFit fit;
  fit.kept.assign(touches, true);
  const TouchSolver solver(model, options, names);
  Pass pass;
  VectorXd weight;
  VectorXd at = start;
  for (;;) {
    const int used = static_cast<int>(std::count(fit.kept.begin(), fit.kept.end(), true) *
                                      static_cast<std::ptrdiff_t>(options.per_touch));
    fit.dof = used - static_cast<int>(start.size());
    if (fit.dof < 0)
      throw text::InputError(fmt::format("{} observations are too few for {} unknowns", used, start.size()));
    pass = solver.solve(at, fit.kept);
    weight = solver.weights(observations, fit.kept);
    const auto outlier = worst(pass, weight, options, used, fit.dof);
    if (!outlier || fit.outliers.size() * 4 >= touches) break;
    fit.kept[outlier->touch] = false;
    fit.outliers.push_back(*outlier);
    at = pass.value;
  }
  fit.value = pass.value;
  fit.residual = pass.residual;
  const double chi2 = chi_square(pass, weight);
  double sum = 0;
  int count = 0;
  for (Index i = 0; i < observations; ++i)
    if (weight(i) != 0) sum += pass.residual(i) * pass.residual(i), ++count;
  fit.rms = std::sqrt(sum / count);
  fit.sigma = fit.dof > 0 ? std::sqrt(sum / fit.dof) : 0;
  const double reduced = fit.dof > 0 ? chi2 / fit.dof : 0;
  const VectorXd& s = pass.svd.singularValues();
  fit.condition = s(s.size() - 1) / s(0);
  const MatrixXd half =
      pass.scale.cwiseInverse().asDiagonal() * pass.svd.matrixV() * s.cwiseInverse().asDiagonal();
  fit.covariance = half * half.transpose() * (options.u ? std::max(1.0, reduced) : reduced);
  return fit;
}

VectorXd algebraic_centre(const MatrixXd& points) {
  MatrixXd a(points.rows(), points.cols() + 1);
  a.leftCols(points.cols()) = 2 * points;
  a.col(points.cols()).setOnes();
  VectorXd s = maths::solve_symmetric(a.transpose() * a, a.transpose() * points.rowwise().squaredNorm());
  const double square = s(points.cols()) + s.head(points.cols()).squaredNorm();
  s(points.cols()) = std::sqrt(std::max(1e-12, square));
  return s;
}

}  // namespace vernier::probe
