// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "tools/format/urdf_chain.h"

namespace vernier::exchange {

/// The URDF file from which a machine file was made. `tip`: the end link; empty: the only end of the arm.
struct UrdfOriginal {
  std::string text, file, tip;
};

/// An arm of ideal joints with all joint variables at 0, in the base frame of its machine file.
struct IdealArm {
  std::vector<std::string> joints;      // names, from the base to the tool
  std::vector<format::JointLine> axes;  // of these joints
  Eigen::Isometry3d last;               // frame of the last row, without the tool point; mm
  std::array<double, 3> tool_mm{};      // tool point in this frame
};

/// The original URDF with the joints of a calibrated arm.
struct CalibratedOriginal {
  std::string text, tip;
  std::array<double, 3> tool_mm{};  // tool point in the frame of the tip link
  bool added_tip = false;           // the tip link is new, because no fixed joint precedes the original tip
};

/// Returns the original text with calibrated origins of its joints. Links, meshes, limits, names, comments
/// and the axes of the joints remain. A moving joint gets the frame on its calibrated axis with which all
/// origins change least (sum of the squares of translations and of rotations at 100 mm). The rest of the
/// calibration is in the first fixed joint behind the last moving joint; without such a joint the result has
/// one more link. `nominal`: the nominal arm of the machine file. Throws InputError if `nominal` is not the
/// arm of the original.
CalibratedOriginal calibrated_original(const UrdfOriginal& original, const IdealArm& calibrated,
                                       const IdealArm& nominal);

}  // namespace vernier::exchange
