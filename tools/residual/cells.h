// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/residual/sample.h"

namespace vernier::residual {

/// Returns mean residual vectors over at most 5 x 5 x 5 parts of the volume (lengths: x y z directly,
/// `length` along the bar, `d` along its normal). residual: mm or deg, one per observation.
std::vector<FailureCell> failure_cells(const model::Machine& machine, const model::Measurement& measurement,
                                       const Eigen::VectorXd& residual);

}  // namespace vernier::residual
