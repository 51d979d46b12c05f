// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace vernier::registry {

/// Readings of one machine in the order of their time: rows of the model, days, and what their stated
/// uncertainty is to that of the fleet.
struct WanderSeries {
  std::vector<Eigen::Index> row;
  std::vector<double> days, weight;
};

/// How far each machine wanders beside the readings' own scatter, and how long it remembers: an
/// Ornstein-Uhlenbeck process (over times short beside `days` a random walk). ratio: its variance over that
/// of a reading; 0: readings are independent.
struct Wander {
  double ratio = 0, days = 0;
  double gain = 0;  // fall of -2 log likelihood against independent readings
};

/// Restricted maximum likelihood (Patterson and Thompson 1971) of what is left of the readings, in units of
/// their uncertainty, when each machine may have a level and a steady rate of its own: over ratios and times
/// on a grid of factors of two. Of those that the readings do not exclude at 95 % the one under which rates
/// are known worst. tool.
Wander estimated_wander(const std::vector<WanderSeries>& machines, const Eigen::VectorXd& left);

/// Multiplies the rows of each machine by the inverse root of their covariance: as if they were independent.
/// tool.
void whiten(const std::vector<WanderSeries>& machines, const Wander& wander, Eigen::MatrixXd& columns);

}  // namespace vernier::registry
