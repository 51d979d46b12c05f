// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace vernier::registry {

/// Readings of one machine in the order of their time: rows of the model, days, and the stated uncertainty
/// divided by that of the fleet.
struct WanderSeries {
  std::vector<Eigen::Index> row;
  std::vector<double> days, weight;
};

/// Wander of each machine in addition to the scatter of the readings, and its correlation time. The wander is
/// an Ornstein-Uhlenbeck process (a random walk over times short compared with `days`). ratio: its variance
/// divided by that of a reading; 0: readings are independent.
struct Wander {
  double ratio = 0, days = 0;
  double gain = 0;  // fall of -2 log likelihood against independent readings
};

/// Estimates the wander by restricted maximum likelihood (Patterson and Thompson 1971) of the residual of the
/// readings, in units of their uncertainty, with a level and a steady rate for each machine. Evaluates ratios
/// and times on a grid of factors of two. Among the values that the readings do not exclude at 95 %, the
/// function returns the value for which rates have the largest uncertainty.
Wander estimated_wander(const std::vector<WanderSeries>& machines, const Eigen::VectorXd& left);

/// Multiplies the rows of each machine by the inverse root of their covariance: the rows are then
/// independent.
void whiten(const std::vector<WanderSeries>& machines, const Wander& wander, Eigen::MatrixXd& columns);

}  // namespace vernier::registry
