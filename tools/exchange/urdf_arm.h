// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::exchange {

/// A robot as URDF (wiki.ros.org/urdf/XML), and the difference between the URDF and the machine.
struct UrdfFile {
  std::string text;
  double worst_um = 0, worst_urad = 0;  // of tool point and tool direction
  std::size_t positions = 0;            // that were evaluated
};

/// Returns an arm with one joint for each axis. The origin and the axis of each joint are those about which
/// (along which) the fitted chain really moves, with the other joints at zero, or in the middle of a range
/// without zero. Links: base_link, then one for each axis, then tool. In this position each frame is parallel
/// to the base. URDF has ideal joints: errors that change with the joints, inputs or direction remain;
/// worst_um states their size at 1000 poses within the ranges (fixed seed). `at` (count 1): inputs, motion.
/// Throws InputError if an axis moves the workpiece, or if an axis moves no transform.
UrdfFile urdf_arm(const model::Machine& machine, const model::States& at);

}  // namespace vernier::exchange
