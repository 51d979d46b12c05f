// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "tools/fit/noise/noise_layout.h"

namespace vernier::fit {

/// Components of a noise model, relative to the independent noise: ratios of variances.
struct NoiseRatios {
  double pose = 0, run = 0, drift = 0, time_constant = 1;
  bool in_time = false;      // else the time constant is a number of rows
  std::uint32_t drifts = 0;  // kinds of reading that drift: bit n is kind n; 0: all
};

/// Transforms readings to independent readings. The variance of the transformed readings is 1. whiten() uses
/// a Kalman filter of three states (drift, run, pose) along each series. `readings`: one column per quantity,
/// one row per reading. Returns log det of the covariance. Computing time: rows times columns.
double whiten(const NoiseLayout& layout, const NoiseRatios& ratios, Eigen::MatrixXd& readings);

}  // namespace vernier::fit
