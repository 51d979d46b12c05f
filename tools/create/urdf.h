// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "tools/create/machine_plan.h"

namespace vernier::create {

/// A robot arm from a URDF file (Unified Robot Description Format, wiki.ros.org/urdf/XML), as rows of Denavit
/// and Hartenberg. The arm extends from the root link to one of the end links. If the axes of two joints are
/// parallel within 0.05 rad, the row has Hayati's form.
struct UrdfArm {
  std::string name, root, tip;
  std::vector<DhRow> rows;
  std::vector<PlannedAxis> axes;  // names and limits of the joints; deg, mm
  /// Frame of the first row in the frame of the root link, T(X,Y,Z)·Rx·Ry·Rz: mm, deg
  std::array<double, 6> base{};
  /// Frame of the end link in the frame of the last row, T(X,Y,Z)·Rx·Ry·Rz: mm, deg
  std::array<double, 6> tip_frame{};
  // The same frame as rotation and place, mm.
  Eigen::Matrix3d tip_rotation;
  Eigen::Vector3d tip_at;
  /// Converts a point from the frame of the end link to the frame of the last row, rounded to 1e-9 mm.
  std::array<double, 3> tool(const std::array<double, 3>& in_tip) const;
};

/// `tip`: name of the end link; empty: the only end of the chain with the most moving joints. Joints that do
/// not move (`fixed`) become parts of the links. Throws InputError with file, line and word for: text that is
/// not URDF, an xacro that is not expanded, a joint type that an arm does not have (floating, planar, mimic),
/// a link that does not exist, a robot with several ends.
UrdfArm parse_urdf(const std::string& text, const std::string& file, const std::string& tip);

}  // namespace vernier::create
