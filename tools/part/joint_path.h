// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/part/surface/flank_path.h"

namespace vernier::part {

/// Axis positions of a machine with X and Z slides and B head on the tool side, and Y slide and C table on
/// the workpiece side.
struct JointPose {
  double x_mm = 0, y_mm = 0, z_mm = 0, b_deg = 0, c_deg = 0;
};

/// Position of the tool tip (workpiece coordinates, mm), and direction of the tool axis (unit vector from the
/// tip to the spindle).
struct ToolPose {
  Eigen::Vector3d tip, axis;
};

/// Selects the solution of tan(C) = -j/i for the rotary axes. kContinuous: C turns as little as possible from
/// pose to pose, and B changes its sign when the tool passes the vertical. kPositiveB: B stays positive, so
/// that C jumps by 180 deg when the tool passes the vertical.
enum class RotarySolution : std::uint8_t { kContinuous, kPositiveB };

/// Returns the pose of the tool from the axis positions of the nominal machine (forward kinematics, equation
/// 9 of the paper). `pivot_mm`: distance from the B axis to the tool tip.
ToolPose tool_pose(const JointPose& q, double pivot_mm);

/// Returns the axis positions for one tool pose (inverse kinematics) with given rotary axes.
JointPose joints_for(const ToolPose& pose, double pivot_mm, double b_deg, double c_deg);

/// Returns the axis positions along a path of tool poses (inverse kinematics). Where the tool is vertical, C
/// is not determined. Where the tool is vertical, C changes linearly between its values at both ends of the
/// vertical part. The inverse kinematics of the path has two continuous solutions, which differ by half a
/// turn of C. Of the two continuous solutions for the path, the solution with the smaller |C| is used.
/// `poses`: tool poses in the order of the path, so close that C turns less than 90 deg between two poses.
std::vector<JointPose> back_solution(const std::vector<ToolPose>& poses, double pivot_mm,
                                     RotarySolution solution = RotarySolution::kContinuous);

/// Returns the axis positions along a flank at the parameters `u` (increasing, 0..1). The angle C is followed
/// on a finer grid that includes the values `u`.
std::vector<JointPose> joint_path(const RuledSurface& surface, const Cutter& cutter,
                                  const std::vector<double>& u, double pivot_mm,
                                  RotarySolution solution = RotarySolution::kContinuous);

}  // namespace vernier::part
