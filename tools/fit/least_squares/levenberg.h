// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

namespace vernier::fit {

/// Data that a least-squares problem gives to the solver at a point: the first and second
/// derivative of half the weighted sum of squares.
struct NormalEquations {
  double cost = 0;           // sum of squared weighted residuals
  Eigen::MatrixXd normal;    // J^T W^2 J
  Eigen::VectorXd gradient;  // J^T W^2 (measured - predicted)
};

/// The first derivative alone. It needs a fraction of the computing time.
struct Slope {
  double cost = 0;           // infinity if the model is undefined
  Eigen::VectorXd gradient;  // J^T W^2 (measured - predicted)
};

struct LevenbergOptions {
  int max_iterations = 100;
  /// Directions whose scaled square (unit diagonal) is below this limit are not seen: at the
  /// start, or when a step is computed. The step does not move along them. It is observability's
  /// cutoff, squared.
  double unseen = 1e-10;
  /// A decrease of the cost below this value is negligible. The fit passes the variance of an
  /// observation times a small factor. Then no parameter would move by more than a few percent of
  /// its standard uncertainty.
  std::function<double(double)> negligible = [](double cost) { return 1e-14 * cost; };
  /// Returns J^T W^2 p'' of a point and a step. p'' is the second derivative of the predictions
  /// along the step. With it, a failed step is curved along the valley (geodesic acceleration).
  /// Without it the step is straight.
  std::function<Eigen::VectorXd(const Eigen::VectorXd&, const Eigen::VectorXd&)> bend;
  /// With it a good factor is used for several steps (chord steps). Each of them needs only a
  /// gradient.
  std::function<Slope(const Eigen::VectorXd&)> slope;
  std::function<void(int, double)> progress;
};

struct LevenbergResult {
  Eigen::VectorXd point;
  double cost = 0;
  int iterations = 0;
  bool converged = false;
  /// Parameters that are held in place of the directions that stay at their start. Empty, or one
  /// entry per parameter.
  std::vector<char> held;
};

/// Gauss-Newton in the directions that the data determine, with column scaling.
/// Levenberg-Marquardt if a step fails (Nocedal and Wright, Numerical Optimization, 2nd ed.,
/// section 10.3; damping update by gain ratio, Nielsen 1999). Directions that are not seen at the
/// start stay there without damping. `cost` evaluates the cost alone. It may return infinity for a
/// point at which the model is undefined.
LevenbergResult minimise(const Eigen::VectorXd& start,
                         const std::function<NormalEquations(const Eigen::VectorXd&)>& equations,
                         const std::function<double(const Eigen::VectorXd&)>& cost,
                         const LevenbergOptions& options);

}  // namespace vernier::fit
