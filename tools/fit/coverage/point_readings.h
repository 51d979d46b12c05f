// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/measurement.h"
#include "tools/model/states.h"

namespace vernier::fit {

/// Returns a measurement with readings x, y, z of the tool point at every state; the value of each reading is
/// 0. The point readings are used to evaluate a machine, not to fit it. In messages the row N of this
/// measurement has the name "point:N". N begins at 1.
model::Measurement point_readings(const model::States& states);

/// Returns the velocity of each point under the six rigid motions about the origin, as a matrix of 3 N x 6
/// elements.
Eigen::MatrixXd rigid_motions(const Eigen::Matrix3Xd& points);

}  // namespace vernier::fit
