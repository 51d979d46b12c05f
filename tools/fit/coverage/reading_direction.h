// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns the direction of a length reading, a unit vector in workpiece coordinates. For x, y, z the set-up
/// of the row gives the direction; for d the direction is the normal of the row. Zero for lengths to a centre
/// or another row, which have many directions.
Eigen::Vector3d reading_direction(const model::Machine& machine, const model::Measurement& rows,
                                  const model::Observation& reading);

}  // namespace vernier::fit
