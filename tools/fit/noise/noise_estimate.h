// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/fit/noise/noise.h"
#include "tools/fit/noise/noise_thresholds.h"

namespace vernier::fit {

/// Limit for the number of readings times the square of the number of fitted columns. Above the limit, an
/// evaluation of the likelihood uses only the number of fitted columns, not their values.
inline constexpr double kMostNoiseProducts = 2e7;

/// Estimates the noise model from a residual by restricted maximum likelihood (Patterson and Thompson 1971),
/// which accounts for the fitted columns. `residual`: the weighted residual; large values are first limited
/// to a few robust standard deviations. `fitted`: orthonormal columns that were fitted to the readings. A
/// noise component is included if -2 log likelihood decreases by more than chance explains. `with_u`: true if
/// u is given. If u is given, the standard deviation of all noise components together is at least 1
/// (in units of u).
NoiseModel estimate_noise(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                          const Eigen::MatrixXd& fitted, bool with_u, const NoiseThresholds& limits = {});

}  // namespace vernier::fit
