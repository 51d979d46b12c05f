// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/residual/sample.h"

namespace vernier::residual {

/// Returns the mean residual vectors in at most 5 x 5 x 5 parts of the volume, points and vectors in
/// workpiece coordinates: instruments with set-ups of their own have one picture. Lengths are used: x y z
/// directly, `length` along the bar, `d` along its normal. `residual`: one value per observation, mm or deg.
std::vector<FailureCell> failure_cells(const model::Machine& machine, const model::Measurement& measurement,
                                       const Eigen::VectorXd& residual);

}  // namespace vernier::residual
