// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/part/b_head_machine.h"

namespace vernier::part {

/// A point of the part: flank 0 (A) or 1 (B), and the position of the point on the flank.
struct PartPoint {
  std::size_t flank = 0;
  double u = 0, v = 0;
};

/// Point and direction of the evaluated tool displacement. Contact: the cutter is a rigid body; its
/// displacement is evaluated at the height of the point, along the surface normal at the point. Tip: the
/// displacement of the tool tip along N(u,1), as in the paper. In plane: like contact, but only the
/// horizontal part of the displacement, along the horizontal part of the normal (unit length). A profile at
/// constant height shows this value for a nearly vertical wall.
enum class DefectReading : std::uint8_t { kContact, kTip, kInPlane };

struct DefectOptions {
  Cutter cutter;
  DefectReading reading = DefectReading::kContact;
  RotarySolution solution = RotarySolution::kContinuous;
};

/// Displacement of the tool by the errors of a machine: actual - nominal chain, in workpiece coordinates.
struct ToolDisplacement {
  Eigen::Vector3d shift;  // mm, exact, at the height asked for
  Eigen::Matrix3Xd by;    // its derivatives, 3 x free statics of the machine, mm per unit of the static
};

/// Returns the displacements at joint poses, for the point of the tool axis `height_mm` above the tip (one
/// height per joint pose).
std::vector<ToolDisplacement> displacements(const BHeadMachine& machine, const std::vector<JointPose>& joints,
                                            const std::vector<double>& height_mm);

/// Indices of the statics of `by` and of the Jacobian of a part, in the order of the machine file.
std::vector<std::size_t> free_statics(const model::Machine& machine);

/// Effect of the errors of a machine on the part, at N points.
struct PartDefect {
  std::vector<JointPose> joints;  // machine positions when the point is cut
  Eigen::Matrix3Xd position,
      normal;                 // nominal surface, workpiece coordinates; normal of the reading: unit, outward
  Eigen::VectorXd defect_mm;  // along the normal, positive: material left; exact, not linearised
  /// Matrix d defect / d static, N x free statics, mm per unit of the static, at the machine's values.
  Eigen::MatrixXd jacobian;
};

/// Mdef(u) = n . (displacement of the tool at the point - displacement at the origin of the work coordinates,
/// where the offsets were set); displacement = actual - nominal chain. The part is clamped on the table where
/// it was cut; the part is not aligned. The point counts as cut at its parameter u. The true contact of the
/// envelope is up to 0.55 mm further along the surface at 11 mm height.
PartDefect part_defect(const BHeadMachine& machine, const std::vector<PartPoint>& points,
                       const DefectOptions& options = {});

/// Returns the hundred points of the test: 25 on each flank at the bottom and the top line (11 and 25 mm), at
/// u = 0.02, 0.06 ... 0.98. The points are in the order of the flanks, on each flank the bottom line first.
std::vector<PartPoint> standard_points();
inline constexpr std::size_t kPointsPerLine = 25;  // of the test part's standard

}  // namespace vernier::part
