// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/part/surface/flank_path.h"

namespace vernier::part {

/// Axis positions of the machine with X and Z slides, B head on the tool side, Y slide and C table on the
/// workpiece side.
struct JointPose {
  double x_mm = 0, y_mm = 0, z_mm = 0, b_deg = 0, c_deg = 0;
};

/// Tool tip (workpiece coordinates, mm) and tool axis (unit, from the tip to the spindle).
struct ToolPose {
  Eigen::Vector3d tip, axis;
};

/// Choice of the solution of tan(C) = -j/i. Continuous: C turns as little as possible from pose to pose and B
/// changes sign when the tool passes the vertical. Positive B: C jumps by 180 deg when the tool passes the
/// vertical.
enum class RotarySolution : std::uint8_t { kContinuous, kPositiveB };

/// Direct solution (the paper's equation 9): the nominal machine. pivot_mm: B axis to tool tip.
ToolPose tool_pose(const JointPose& q, double pivot_mm);

/// Returns the back solution of one pose with given rotary axes.
JointPose joints_for(const ToolPose& pose, double pivot_mm, double b_deg, double c_deg);

/// Returns the back solution along a path. Where the tool is vertical, C is free: C changes evenly between
/// its values at both ends of the vertical part. There are two continuous solutions, which differ by a half
/// turn; the solution with the smaller |C| is used. poses: in the order of the path, close enough that C
/// turns less than 90 deg between two poses.
std::vector<JointPose> back_solution(const std::vector<ToolPose>& poses, double pivot_mm,
                                     RotarySolution solution = RotarySolution::kContinuous);

/// Returns the joint path of a flank at `u` (increasing, 0..1). C is followed on a finer grid that includes
/// `u`.
std::vector<JointPose> joint_path(const RuledSurface& surface, const Cutter& cutter,
                                  const std::vector<double>& u, double pivot_mm,
                                  RotarySolution solution = RotarySolution::kContinuous);

}  // namespace vernier::part
