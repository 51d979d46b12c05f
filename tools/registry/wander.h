// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace vernier::registry {

/// Readings of one machine in time order: rows of the model, times in days, and the stated uncertainty
/// divided by that of the fleet.
struct WanderSeries {
  std::vector<Eigen::Index> row;
  std::vector<double> days, weight;
};

/// Wander of the machines: a slow random change of each machine, in addition to the scatter of the readings,
/// with a correlation time. The wander is an Ornstein-Uhlenbeck process. Over times that are short compared
/// with `days`, it is a random walk. `ratio`: variance of the wander divided by the variance of a reading; 0:
/// the readings are independent.
struct Wander {
  double ratio = 0, days = 0;
  double gain = 0;  // decrease of -2 log likelihood compared with independent readings
};

/// Estimates the wander from the residual of the readings by restricted maximum likelihood (Patterson and
/// Thompson 1971). The residual is in units of its uncertainty, after a fit of a level and a constant rate
/// for each machine. The ratios and times are evaluated on a grid with factors of two. Among the values that
/// the readings do not reject at 95 %, the function returns the value for which the rates have the largest
/// uncertainty.
Wander estimated_wander(const std::vector<WanderSeries>& machines, const Eigen::VectorXd& left);

/// Multiplies the rows of each machine by the inverse square root of their covariance, so that the rows are
/// independent.
void whiten(const std::vector<WanderSeries>& machines, const Wander& wander, Eigen::MatrixXd& columns);

}  // namespace vernier::registry
