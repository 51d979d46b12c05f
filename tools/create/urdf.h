// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "tools/create/machine_plan.h"

namespace vernier::create {

/// An arm of a URDF file (Unified Robot Description Format, wiki.ros.org/urdf/XML), from its root link to one
/// of its end links, in rows of Denavit and Hartenberg. If the axes of two joints are parallel to 0.05 rad or
/// better, the row has Hayati's form.
struct UrdfArm {
  std::string name, root, tip;
  std::vector<DhRow> rows;
  std::vector<PlannedAxis> axes;  // names and limits of the joints; deg, mm
  std::array<double, 6> base{};   // of the first row's frame in the root's, T(X,Y,Z)·Rx·Ry·Rz: mm, deg
  // Frame of the tip in the frame of the last row, mm.
  Eigen::Matrix3d tip_rotation;
  Eigen::Vector3d tip_at;
  /// Converts a point of the tip's frame to the frame of the last row, to 1e-9 mm.
  std::array<double, 3> tool(const std::array<double, 3>& in_tip) const;
};

/// tip: name of a link; empty: the only end of the chain with most moving joints. Joints that do not move
/// (`fixed`) become part of the links. Throws InputError with file, line and word: no URDF, an xacro that is
/// not expanded, a joint type that an arm does not have (floating, planar, mimic), a link that does not
/// exist, several ends.
UrdfArm parse_urdf(const std::string& text, const std::string& file, const std::string& tip);

}  // namespace vernier::create
