#pragma once
#include <Eigen/Core>
#include <functional>

namespace vernier {

/// What a least-squares problem hands to the solver at a point: half the weighted sum of squares' two
/// derivatives.
struct NormalEquations {
  double cost = 0;           // sum of squared weighted residuals
  Eigen::MatrixXd normal;    // J^T W^2 J
  Eigen::VectorXd gradient;  // J^T W^2 (measured - predicted)
};

struct LevenbergOptions {
  int max_iterations = 100;
  /// Least damping, in units of the scaled normal matrix (unit diagonal). It keeps unidentified directions at
  /// their start; identified ones (scaled singular value above 1e-5) still converge, at worst by a factor of
  /// ten a step.
  double least_damping = 1e-8;
  /// A fall of the cost below this is nothing: the fit passes the variance of an observation times a small
  /// share, so that no parameter would move by more than a few percent of its standard uncertainty.
  std::function<double(double)> negligible = [](double cost) { return 1e-14 * cost; };
  /// J^T W^2 p'' of a point and a step: p'' is the second derivative of the predictions along the step. With
  /// it the step is bent along the valley (geodesic acceleration), without it it is straight.
  std::function<Eigen::VectorXd(const Eigen::VectorXd&, const Eigen::VectorXd&)> bend;
  std::function<void(int, double)> progress;
};

struct LevenbergResult {
  Eigen::VectorXd point;
  double cost = 0;
  int iterations = 0;
  bool converged = false;
};

/// Levenberg-Marquardt on normal equations with column scaling (Nocedal and Wright, Numerical Optimization,
/// 2nd ed., section 10.3; damping update by gain ratio, Nielsen 1999). `cost` evaluates the cost alone and
/// may return infinity for a point where the model is undefined.
LevenbergResult minimise(const Eigen::VectorXd& start,
                         const std::function<NormalEquations(const Eigen::VectorXd&)>& equations,
                         const std::function<double(const Eigen::VectorXd&)>& cost,
                         const LevenbergOptions& options);

}  // namespace vernier
