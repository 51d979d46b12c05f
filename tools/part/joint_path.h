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
/// changes sign when the tool passes the vertical. Positive B: C jumps by 180 deg there.
enum class RotarySolution : std::uint8_t { kContinuous, kPositiveB };

/// Direct solution (the paper's equation 9): the nominal machine. pivot_mm: B axis to tool tip.
ToolPose tool_pose(const JointPose& q, double pivot_mm);

/// Back solution of one pose with the rotary axes given.
JointPose joints_for(const ToolPose& pose, double pivot_mm, double b_deg, double c_deg);

/// Back solution along a path. Where the tool is vertical C is free and runs evenly between its values at
/// either end of that stretch. Of the two continuous solutions, which lie a half turn apart, the one with the
/// smaller |C| is taken. poses: in the order of the path, close enough that C turns less than 90 deg from one
/// to the next. tool.
std::vector<JointPose> back_solution(const std::vector<ToolPose>& poses, double pivot_mm,
                                     RotarySolution solution = RotarySolution::kContinuous);

/// The joint path of a flank at `u` (increasing, 0..1); C is followed on a finer grid that includes them.
std::vector<JointPose> joint_path(const RuledSurface& surface, const Cutter& cutter,
                                  const std::vector<double>& u, double pivot_mm,
                                  RotarySolution solution = RotarySolution::kContinuous);

}  // namespace vernier::part
