// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/fit/noise_layout.h"

namespace vernier::fit {

/// The parts of a model, relative to the own one: squares.
struct NoiseRatios {
  double pose = 0, run = 0, drift = 0, time_constant = 1;
  bool in_time = false;  // else the time constant is a number of rows
};

/// Makes readings independent, whose own part has variance 1, by a Kalman filter of three states (drift, run,
/// pose) along each series. `readings`: a reading is a column. Returns log det of the covariance. Cost: rows
/// times columns. tool.
double whiten(const NoiseLayout& layout, const NoiseRatios& ratios, Eigen::MatrixXd& readings);

}  // namespace vernier::fit
