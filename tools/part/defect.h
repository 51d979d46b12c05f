// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/part/b_head_machine.h"

namespace vernier::part {

/// A point of the test part: the flank 0 (A) or 1 (B), and the parameters u, v of the point on the flank.
struct PartPoint {
  std::size_t flank = 0;
  double u = 0, v = 0;
};

/// Method to evaluate the tool displacement at a point of the part. kContact: the cutter is a rigid body. The
/// displacement of the cutter is evaluated at the height of the point, along the surface normal at the point.
/// kTip: the displacement of the tool tip along N(u,1), as in the paper. kInPlane: like kContact, but only
/// the horizontal part of the displacement, along the horizontal part of the normal (unit length). A profile
/// at constant height shows the kInPlane value for a nearly vertical wall.
enum class DefectReading : std::uint8_t { kContact, kTip, kInPlane };

struct DefectOptions {
  Cutter cutter;
  DefectReading reading = DefectReading::kContact;
  RotarySolution solution = RotarySolution::kContinuous;
};

/// Displacement of the tool by the errors of a machine: actual minus nominal chain, in workpiece coordinates.
struct ToolDisplacement {
  Eigen::Vector3d shift;  // displacement at the given height, mm, without linearisation
  Eigen::Matrix3Xd by;    // derivatives of the displacement, 3 x free statics of the machine, mm per unit of
                          // the static
};

/// Returns the tool displacements at joint poses, for the point of the tool axis that is `height_mm` above
/// the tip (one height for each joint pose).
std::vector<ToolDisplacement> displacements(const BHeadMachine& machine, const std::vector<JointPose>& joints,
                                            const std::vector<double>& height_mm);

/// Returns the indices of the free statics, in the order of the machine file. ToolDisplacement::by and the
/// Jacobian of a part have one column for each of them.
std::vector<std::size_t> free_statics(const model::Machine& machine);

/// Effect of the errors of a machine on N points of the test part.
struct PartDefect {
  std::vector<JointPose> joints;  // axis positions of the machine when the point is cut
  Eigen::Matrix3Xd position,
      normal;                 // point of the nominal surface, workpiece coordinates; normal for the defect:
                              // unit length, outward
  Eigen::VectorXd defect_mm;  // defect along the normal, without linearisation; positive: material remains
  /// Matrix d defect / d static, N x free statics, mm per unit of the static, at the machine's values.
  Eigen::MatrixXd jacobian;
};

/// Computes the defect of the part: Mdef(u) = n . (displacement of the tool at the point - displacement at
/// the origin of the work coordinates, where the offsets were set). A displacement is actual minus nominal
/// chain. The part counts as measured on the table on which it was cut, without unclamping and without
/// alignment. The computation assumes that each point of the flank is cut when the cutter is at the
/// parameter u of the point. The true contact point of the envelope is up to 0.55 mm further along the
/// surface at 11 mm height.
PartDefect part_defect(const BHeadMachine& machine, const std::vector<PartPoint>& points,
                       const DefectOptions& options = {});

/// Returns the hundred points of the test: 25 points on each flank at the bottom and the top line (11 and 25
/// mm), at u = 0.02, 0.06 ... 0.98. The points are in the order of the flanks; on each flank the points of
/// the bottom line are first.
std::vector<PartPoint> standard_points();
inline constexpr std::size_t kPointsPerLine = 25;  // number of points per line in the standard of the test
                                                   // part

}  // namespace vernier::part
