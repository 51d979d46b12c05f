// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vernier::probe {

/// An outlier: a touch that does not agree with the other touches.
struct TouchOutlier {
  std::size_t touch = 0;
  double residual = 0;  // residual of the fit that excluded this touch, in the unit of the observation
  double t = 0;         // externally studentised residual
  double p_value = 0;   // p-value after Bonferroni correction for the number of observations
};

/// Result of a least-squares fit to touches.
struct TouchFit {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd residual;  // one value per observation, including outliers
  std::vector<bool> kept;    // one flag per touch; false: excluded as an outlier
  std::vector<TouchOutlier> outliers;
  double rms = 0;        // rms of the residuals of all touches that were kept
  double sigma = 0;      // standard deviation of these residuals, corrected for the degrees of freedom
  double condition = 0;  // smallest divided by largest singular value of the scaled Jacobian
  int dof = 0;

  double std_of(Eigen::Index i) const { return std::sqrt(covariance(i, i)); }
};

/// Function that returns the residuals of all observations for given parameters. Observation k belongs to the
/// touch with index k / per_touch.
using TouchModel = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

struct TouchFitOptions {
  std::size_t per_touch = 1;
  std::optional<Eigen::VectorXd> u;  // standard uncertainty of each observation
  double outlier_level = 0.01;       // probability that a touch of a good set is excluded; 0: no touch is
                                     // excluded
};

/// Fits the parameters by Gauss-Newton iteration with step halving, beginning at `start`. After the
/// iteration, touches are excluded one by one. The touch with the least probable deleted residual is excluded
/// if its p-value (Student's t, Bonferroni) is below outlier_level. The covariance is computed from u, and is
/// multiplied by chi^2/dof if chi^2/dof exceeds 1. If the touches have no u, the covariance of the
/// parameters is computed from the residual. Throws InputError if there are fewer observations than
/// parameters plus one, or if the touches do not determine the parameters (with the `names` of the weakest).
/// The test is that of R. D. Cook and S. Weisberg, Residuals and Influence in Regression, 1982, 2.2.
TouchFit fit_touches(const TouchModel& model, const Eigen::VectorXd& start, const TouchFitOptions& options,
                     const std::vector<std::string>& names);

/// Returns the circle or sphere that best solves |m|^2 = 2 m c + k by normal equations. The returned circle
/// or sphere is the start of a fit. `points`: one point per row, with two or three columns, relative to their
/// centroid. The result of algebraic_centre() contains the centre and then the radius.
Eigen::VectorXd algebraic_centre(const Eigen::MatrixXd& points);

}  // namespace vernier::probe
