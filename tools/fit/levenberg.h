// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

namespace vernier::fit {

/// What a least-squares problem hands to the solver at a point: half the weighted sum of squares' two
/// derivatives.
struct NormalEquations {
  double cost = 0;           // sum of squared weighted residuals
  Eigen::MatrixXd normal;    // J^T W^2 J
  Eigen::VectorXd gradient;  // J^T W^2 (measured - predicted)
};

/// The first derivative alone: a fraction of the work.
struct Slope {
  double cost = 0;           // infinity where the model is undefined
  Eigen::VectorXd gradient;  // J^T W^2 (measured - predicted)
};

struct LevenbergOptions {
  int max_iterations = 100;
  /// Directions whose scaled square (unit diagonal) is below this at the start, or when a step is worked out,
  /// are not seen there: the step leaves them alone. As observability's cutoff, squared.
  double unseen = 1e-10;
  /// A fall of the cost below this is nothing: the fit passes the variance of an observation times a small
  /// share, so that no parameter would move by more than a few percent of its standard uncertainty.
  std::function<double(double)> negligible = [](double cost) { return 1e-14 * cost; };
  /// J^T W^2 p'' of a point and a step: p'' is the second derivative of the predictions along the step. With
  /// it a step that failed is bent along the valley (geodesic acceleration), without it it is straight.
  std::function<Eigen::VectorXd(const Eigen::VectorXd&, const Eigen::VectorXd&)> bend;
  /// With it a good factor serves several steps (chord steps), each for the price of a gradient.
  std::function<Slope(const Eigen::VectorXd&)> slope;
  std::function<void(int, double)> progress;
};

struct LevenbergResult {
  Eigen::VectorXd point;
  double cost = 0;
  int iterations = 0;
  bool converged = false;
  /// Parameters that stand for the directions left at their start; empty or one entry a parameter.
  std::vector<char> held;
};

/// Gauss-Newton in the directions that the data see, with column scaling; Levenberg-Marquardt where a step
/// fails (Nocedal and Wright, Numerical Optimization, 2nd ed., section 10.3; damping update by gain ratio,
/// Nielsen 1999). Directions that are not seen at the start are left there, not damped. `cost` evaluates the
/// cost alone and may return infinity for a point where the model is undefined.
LevenbergResult minimise(const Eigen::VectorXd& start,
                         const std::function<NormalEquations(const Eigen::VectorXd&)>& equations,
                         const std::function<double(const Eigen::VectorXd&)>& cost,
                         const LevenbergOptions& options);

}  // namespace vernier::fit
