// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns the direction of a length reading, a unit vector in workpiece coordinates. For x, y, z
/// it comes from the row's set-up, for d it is its own normal. Zero for lengths to a centre or
/// another row, which have many directions.
Eigen::Vector3d reading_direction(const model::Machine& machine, const model::Measurement& rows,
                                  const model::Observation& reading);

}  // namespace vernier::fit
