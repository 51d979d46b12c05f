// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

namespace vernier::fit {

/// Data that the solver needs of a least-squares problem at a point: the first and second derivative of half
/// the weighted sum of squares.
struct NormalEquations {
  double cost = 0;           // sum of squared weighted residuals
  Eigen::MatrixXd normal;    // J^T W^2 J
  Eigen::VectorXd gradient;  // J^T W^2 (measured - predicted)
};

/// The first derivative of half the weighted sum of squares. A Slope needs only a fraction of the computing
/// time of NormalEquations.
struct Slope {
  double cost = 0;           // infinity if the model is undefined
  Eigen::VectorXd gradient;  // J^T W^2 (measured - predicted)
};

struct LevenbergOptions {
  int max_iterations = 100;
  /// Limit for the scaled square (unit diagonal) of a direction. A direction below this limit counts as not
  /// determined by the data: at the start, or when a step is computed. The step has no component along such a
  /// direction. The limit is the square of observability's cutoff.
  double unseen = 1e-10;
  /// Returns the largest decrease of the cost that is negligible. The fit passes the variance of an
  /// observation times a small factor. For a smaller decrease of the cost, no parameter would change by more
  /// than a few percent of its standard uncertainty.
  std::function<double(double)> negligible = [](double cost) { return 1e-14 * cost; };
  /// Returns J^T W^2 p'' for a point and a step. p'' is the second derivative of the predictions along the
  /// step. If `bend` is given, a failed step is replaced by a step with geodesic acceleration. If `bend` is
  /// not given, the step is straight.
  std::function<Eigen::VectorXd(const Eigen::VectorXd&, const Eigen::VectorXd&)> bend;
  /// If `slope` is given, one factor of the normal equations is used for several steps (chord steps). Each
  /// chord step needs only a gradient.
  std::function<Slope(const Eigen::VectorXd&)> slope;
  std::function<void(int, double)> progress;
};

struct LevenbergResult {
  Eigen::VectorXd point;
  double cost = 0;
  int iterations = 0;
  bool converged = false;
  /// Parameters that are fixed instead of the undetermined directions. `held` is empty, or has one entry per
  /// parameter.
  std::vector<char> held;
};

/// Gauss-Newton in the directions that the data determine, with column scaling. Levenberg-Marquardt if a step
/// fails (Nocedal and Wright, Numerical Optimization, 2nd ed., section 10.3; damping update by gain ratio,
/// Nielsen 1999). Directions that are not determined at the start keep their start value without damping.
/// `cost` computes only the cost. `cost` may return infinity for a point at which the model is undefined.
LevenbergResult minimise(const Eigen::VectorXd& start,
                         const std::function<NormalEquations(const Eigen::VectorXd&)>& equations,
                         const std::function<double(const Eigen::VectorXd&)>& cost,
                         const LevenbergOptions& options);

}  // namespace vernier::fit
