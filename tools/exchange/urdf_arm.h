// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/exchange/undetermined_joints.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::exchange {

/// A robot arm in the format URDF (wiki.ros.org/urdf/XML), and the difference between the URDF model and the
/// machine.
struct UrdfFile {
  std::string text;
  double worst_um = 0, worst_urad = 0;  // largest difference of the tool point, and of the tool direction
  std::size_t positions = 0;            // number of positions at which the difference was computed
  std::vector<UndeterminedJoint> undetermined;  // joints that the readings of the fit do not determine
};

/// Returns the URDF model of an arm with one joint for each axis. Origin and axis of each joint are those
/// about which (or along which) the fitted chain really moves. The origin and axis of one joint are computed
/// with the other joints at zero, or in the middle of a range that does not contain zero. The links are
/// base_link, one link for each axis, and tool. With the joints at these positions, each frame of the URDF
/// model is parallel to the base. URDF has ideal joints. Errors that depend on joints, inputs or direction
/// therefore remain in a URDF model. The member worst_um states the largest remaining error of the URDF
/// model at 1000 poses within the ranges (fixed seed). `at` (one state): values of inputs and motion. Throws
/// InputError if an axis moves the workpiece, or if an axis moves no transform.
UrdfFile urdf_arm(const model::Machine& machine, const model::States& at);

}  // namespace vernier::exchange
