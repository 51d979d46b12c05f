// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/fit/noise.h"
#include "tools/fit/noise_thresholds.h"

namespace vernier::fit {

/// Readings times the square of what was fitted, beyond which a look at the likelihood takes what was fitted
/// by its number alone.
inline constexpr double kMostNoiseProducts = 6e7;

/// Restricted maximum likelihood (Patterson and Thompson 1971) of a residual beside what was fitted.
/// residual: weighted, held at a few robust spreads first; fitted: orthonormal columns that were fitted to
/// it. A component enters where the likelihood falls by more than chance would make it. `with_u`: all parts
/// together are not below 1. tool.
NoiseModel estimate_noise(const NoiseLayout& layout, const Eigen::VectorXd& residual,
                          const Eigen::MatrixXd& fitted, bool with_u, const NoiseThresholds& limits = {});

}  // namespace vernier::fit
