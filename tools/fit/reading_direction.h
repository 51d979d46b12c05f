// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Direction that a reading of a length looks along, unit vector in workpiece coordinates: x, y, z through
/// the row's set-up, d its own normal; zero for lengths to a centre or another row, which look along many.
Eigen::Vector3d reading_direction(const model::Machine& machine, const model::Measurement& rows,
                                  const model::Observation& reading);

}  // namespace vernier::fit
