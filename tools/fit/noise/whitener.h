// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "tools/fit/noise/noise_layout.h"

namespace vernier::fit {

/// Components of a noise model as ratios of variances: each variance divided by the variance of the
/// independent noise.
struct NoiseRatios {
  double pose = 0, run = 0, drift = 0, time_constant = 1;
  bool in_time = false;      // true: the time constant is in s; false: it is a number of rows
  std::uint32_t drifts = 0;  // kinds of reading that drift: bit n is kind n; 0: all kinds
};

/// Whitens readings: transforms correlated readings to independent readings. The variance of the transformed
/// readings is 1. The method is a Kalman filter of three states (drift, run, pose) along each series.
/// `readings`: one column per quantity, one row per reading. The function returns the logarithm of the
/// determinant of the covariance. The computing time is proportional to the number of rows times the number
/// of columns.
double whiten(const NoiseLayout& layout, const NoiseRatios& ratios, Eigen::MatrixXd& readings);

/// Multiplies by the transpose of the matrix of whiten(): the scalar product of `readings` with whitened
/// readings is that of the result with the readings before whitening. Shape and computing time as of
/// whiten().
void whiten_transposed(const NoiseLayout& layout, const NoiseRatios& ratios, Eigen::MatrixXd& readings);

}  // namespace vernier::fit
