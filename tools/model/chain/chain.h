// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::model {

/// Tool points and tool orientations of N states in workpiece coordinates, without a BaseShift.
struct Poses {
  Eigen::Matrix3Xd position;              // mm
  std::vector<Eigen::Matrix3d> rotation;  // rotation from tool coordinates to workpiece coordinates
};

/// Computes the forward kinematics of the chain: p = W^-1 * T * (0,0,0,1), FORMATS section 1. The result of
/// forward() has no linearisation error and is in double precision. Throws InputError if the value of an
/// expression is not finite. The message of the error names the transform, the degree of freedom and the
/// state.
Poses forward(const Machine& machine, const States& states);

/// Returns the deviation of each state: position of `machine` minus position of the nominal chain of
/// `machine`, mm.
Eigen::Matrix3Xd deviation(const Machine& machine, const States& states);

}  // namespace vernier::model
