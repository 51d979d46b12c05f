// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::model {

/// Tool points and orientations of N states in workpiece coordinates (no BaseShift).
struct Poses {
  Eigen::Matrix3Xd position;              // mm
  std::vector<Eigen::Matrix3d> rotation;  // workpiece <- tool
};

/// Forward kinematics of the chain: p = W^-1 * T * (0,0,0,1), FORMATS section 1. Exact, in double
/// precision. Throws InputError if an expression is not finite. The message names transform,
/// degree of freedom and state.
Poses forward(const Machine& machine, const States& states);

/// Returns the deviation of each state: position of `machine` minus position of the nominal chain of
/// `machine`, mm.
Eigen::Matrix3Xd deviation(const Machine& machine, const States& states);

}  // namespace vernier::model
