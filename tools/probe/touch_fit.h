// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vernier::probe {

/// A touch that does not agree with the other touches.
struct TouchOutlier {
  std::size_t touch = 0;
  double residual = 0;  // of the fit that excluded it, the observation's unit
  double t = 0;         // externally studentised residual
  double p_value = 0;   // after Bonferroni for the number of observations
};

/// A least squares fit to touches.
struct TouchFit {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd residual;  // per observation, outliers too
  std::vector<bool> kept;    // per touch
  std::vector<TouchOutlier> outliers;
  double rms = 0;        // of the kept residuals
  double sigma = 0;      // their standard deviation, corrected for degrees of freedom
  double condition = 0;  // smallest over largest singular value of the scaled Jacobian
  int dof = 0;

  double std_of(Eigen::Index i) const { return std::sqrt(covariance(i, i)); }
};

/// Residuals of all observations at given parameters. Observation k belongs to touch k / per_touch.
using TouchModel = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

struct TouchFitOptions {
  std::size_t per_touch = 1;
  std::optional<Eigen::VectorXd> u;  // standard uncertainty per observation
  double outlier_level = 0.01;       // probability that a good set loses a touch; 0: none is excluded
};

/// Gauss-Newton with step halving from `start`. Then touches are excluded one by one: each time the touch
/// whose deleted residual is least probable, if its probability (Student's t, Bonferroni) is below the level.
/// The covariance is computed from u, and multiplied by chi^2/dof if chi^2/dof exceeds 1; without u it is
/// computed from the residual. Throws InputError: fewer observations than parameters plus one, or parameters
/// that the touches do not determine (`names` of the weakest). Source of the test: R. D. Cook, S. Weisberg,
/// Residuals and Influence in Regression, 1982, 2.2.
TouchFit fit_touches(const TouchModel& model, const Eigen::VectorXd& start, const TouchFitOptions& options,
                     const std::vector<std::string>& names);

/// Returns the circle or sphere that solves |m|^2 = 2 m c + k best, by normal equations: the start of a fit.
/// points: one per row, two or three columns, about their middle. The result is the centre, then the radius.
Eigen::VectorXd algebraic_centre(const Eigen::MatrixXd& points);

}  // namespace vernier::probe
