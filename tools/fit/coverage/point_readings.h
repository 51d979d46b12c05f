// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/measurement.h"
#include "tools/model/states.h"

namespace vernier::fit {

/// Returns readings x, y, z of the tool point at every state, with value 0. These readings are for the
/// evaluation of a machine, not for a fit. Messages name a row "point:N", N from 1.
model::Measurement point_readings(const model::States& states);

/// Velocity of each point under the six rigid motions about the origin, 3 N x 6.
Eigen::MatrixXd rigid_motions(const Eigen::Matrix3Xd& points);

}  // namespace vernier::fit
