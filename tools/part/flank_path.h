// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/part/ruled_surface.h"

namespace vernier::part {

/// A cylindrical cutter: the tip is `length_mm` below the top curve, along the generatrix.
struct Cutter {
  double radius_mm = 10;
  double length_mm = 35;
};

/// How the normal of the path is taken. The paper prints N = +-(R x T), which has no unit length, since
/// T(u,1) is up to 16 deg away from a right angle to R; and it does not say on which side.
struct NormalReading {
  bool unit = true;
  bool outward = true;
};

/// The cutter at parameter u of a flank, and its derivatives by u (workpiece coordinates, mm).
struct FlankPose {
  double u = 0;
  Eigen::Vector3d tip, tip_du;    // tool tip
  Eigen::Vector3d axis, axis_du;  // R: unit, from the tip to the spindle
  Eigen::Vector3d tangent;        // T(u,1): unit, along the top curve
  Eigen::Vector3d normal;         // N(u,1): as the reading says
  double generatrix_mm = 0;       // |C1 - C0|
};

/// Tip = C1 + radius * N(u,1) - length * R: the analytical flank path of the paper's equations 1 to 3. The
/// cutter touches the surface along the whole generatrix only where the surface is not twisted; what it cuts
/// too much is in tools/part/envelope.h. tool.
FlankPose flank_pose(const RuledSurface& surface, const Cutter& cutter, double u, NormalReading reading = {});

}  // namespace vernier::part
