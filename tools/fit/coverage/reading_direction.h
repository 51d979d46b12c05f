// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns the rotation from workpiece coordinates to the measuring frame of the set-up of a row.
Eigen::Matrix3d measuring_frame(const model::Machine& machine, const model::Measurement& rows,
                                std::size_t row);

/// Returns the direction of a length reading, a unit vector in workpiece coordinates. For a reading x, y or
/// z, the set-up of the row gives the direction. For a reading d, the direction is the normal of the row. The
/// direction is zero for a length to a centre or to another row, because such a length has no fixed
/// direction.
Eigen::Vector3d reading_direction(const model::Machine& machine, const model::Measurement& rows,
                                  const model::Observation& reading);

}  // namespace vernier::fit
