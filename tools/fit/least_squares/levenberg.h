// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

namespace vernier::fit {

/// Gradient and normal matrix of a least-squares problem at one point: the first and second derivative of
/// half the weighted sum of squares.
struct NormalEquations {
  double cost = 0;           // sum of squared weighted residuals
  Eigen::MatrixXd normal;    // J^T W^2 J
  Eigen::VectorXd gradient;  // J^T W^2 (measured - predicted)
};

/// Cost and gradient of a least-squares problem at one point, without the normal matrix. The gradient is the
/// first derivative of half the weighted sum of squares. The computing time of a Slope is only a fraction of
/// that of NormalEquations.
struct Slope {
  double cost = 0;           // infinity if the model is undefined
  Eigen::VectorXd gradient;  // J^T W^2 (measured - predicted)
};

struct LevenbergOptions {
  int max_iterations = 100;
  /// Limit for the scaled eigenvalue (of the normal matrix with unit diagonal) of a direction in the
  /// parameters. A direction whose eigenvalue is below the limit counts as not determined by the data, both
  /// at the start and when a step is computed. A step of the solver has no component along a direction that
  /// the data do not determine. The limit of the eigenvalue is the square of the cutoff in observability.h.
  double unseen = 1e-10;
  /// Returns the largest decrease of the cost that counts as negligible. The fit sets this function to the
  /// variance of an observation times a small factor. If the cost decreases by less than the given amount, no
  /// parameter changes by more than a few percent of its standard uncertainty.
  std::function<double(double)> negligible = [](double cost) { return 1e-14 * cost; };
  /// Returns J^T W^2 p'' at a point for a step. The vector p'' is the second derivative of the predictions
  /// along the step. If `bend` is given, a step that fails is replaced by a step with geodesic acceleration.
  /// If `bend` is not given, the steps of the solver have no geodesic acceleration.
  std::function<Eigen::VectorXd(const Eigen::VectorXd&, const Eigen::VectorXd&)> bend;
  /// If `slope` is given, the solver uses one factorisation of the normal equations for several steps (chord
  /// steps). Each chord step needs only the gradient, not a new normal matrix.
  std::function<Slope(const Eigen::VectorXd&)> slope;
  std::function<void(int, double)> progress;
};

struct LevenbergResult {
  Eigen::VectorXd point;
  double cost = 0;
  int iterations = 0;
  bool converged = false;
  /// One flag for each parameter: true if the parameter was fixed to replace a direction that the data do not
  /// determine. The vector `held` is empty if no parameter was fixed.
  std::vector<char> held;
};

/// Minimises a sum of squares: Gauss-Newton steps in the directions that the data determine, with column
/// scaling. If a Gauss-Newton step fails, Levenberg-Marquardt steps follow (Nocedal and Wright, Numerical
/// Optimization, 2nd ed., section 10.3; damping update by gain ratio, Nielsen 1999). Directions that the data
/// do not determine at the start keep their start value, without damping. `cost` returns only the cost at a
/// point. `cost` returns infinity at a point where the model is undefined.
LevenbergResult minimise(const Eigen::VectorXd& start,
                         const std::function<NormalEquations(const Eigen::VectorXd&)>& equations,
                         const std::function<double(const Eigen::VectorXd&)>& cost,
                         const LevenbergOptions& options);

}  // namespace vernier::fit
