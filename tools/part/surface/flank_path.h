// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "tools/part/surface/ruled_surface.h"

namespace vernier::part {

/// A cylindrical cutter. The tip of the cutter is `length_mm` below the top curve, along the generatrix.
struct Cutter {
  double radius_mm = 10;
  double length_mm = 35;
  double touch = 1;  // parameter v of the flank curve that the cutter touches; at other heights the cutter
                     // removes too much material
};

/// Tool paths that the paper defines for the test part. kAnalytical: the path of equations 1 to 3, along the
/// top curve. For the other two paths, the NC programs define a lower curve, and an upper curve for the
/// direction of the tool axis. The control offsets the tool perpendicular to the lower curve and the tool
/// axis (CUT3DC): TP5C1 touches at Z0, TP6C2 at Z11.
enum class ToolPath : std::uint8_t { kAnalytical, kTp5c1, kTp6c2 };

/// Returns the height parameter v at which a path touches the flank (Cutter::touch).
constexpr double touch_of(ToolPath path) {
  constexpr double kLowerOfTp6c2 = 11.0 / 30;  // from table 2 of the paper: Z11 of 30 mm
  return path == ToolPath::kAnalytical ? 1 : path == ToolPath::kTp5c1 ? 0 : kLowerOfTp6c2;
}

/// Definition of the normal N of the path, for which the paper permits several interpretations. The paper
/// prints N = +-(R x T). The vector R x T does not have unit length, because the angle between T(u,1) and R
/// differs from 90 deg by up to 16 deg. The paper does not state to which side of the surface N points.
struct NormalReading {
  bool unit = true;
  bool outward = true;
};

/// Pose of the cutter at parameter u of a flank, and its derivatives by u (workpiece coordinates, mm).
struct FlankPose {
  double u = 0;
  Eigen::Vector3d tip, tip_du;    // position of the tool tip
  Eigen::Vector3d axis, axis_du;  // R: unit vector from the tip to the spindle
  Eigen::Vector3d tangent;        // T: unit vector along the touched curve; T(u,1) for the top curve
  Eigen::Vector3d normal;         // N at the point, as in the measurement
  double generatrix_mm = 0;       // length of the generatrix |C1 - C0|
};

/// Returns the pose of the cutter: Tip = C1 + radius * N - length * R. With N(u,1) this is the analytical
/// flank path of the paper's equations 1 to 3. The cutter touches the surface along the whole generatrix only
/// if the surface is not twisted. tools/part/envelope.h computes the overcut.
FlankPose flank_pose(const RuledSurface& surface, const Cutter& cutter, double u, NormalReading reading = {});

}  // namespace vernier::part
