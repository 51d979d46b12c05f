// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "tools/part/surface/ruled_surface.h"

namespace vernier::part {

/// A cylindrical cutter: the tip is `length_mm` below the top curve, along the generatrix.
struct Cutter {
  double radius_mm = 10;
  double length_mm = 35;
  double touch = 1;  // v of the curve of the flank that it touches; elsewhere it cuts too much
};

/// The paths that the paper defines. Analytical: equations 1 to 3, along the top curve. The programs define a
/// lower curve, and the axis by an upper curve. The control offsets the tool perpendicular to the lower curve
/// and the axis (CUT3DC): TP5C1 touches at Z0, TP6C2 at Z11.
enum class ToolPath : std::uint8_t { kAnalytical, kTp5c1, kTp6c2 };

/// Returns the height of the part at which a path touches: Cutter::touch.
constexpr double touch_of(ToolPath path) {
  constexpr double kLowerOfTp6c2 = 11.0 / 30;  // table 2: Z11 of 30 mm
  return path == ToolPath::kAnalytical ? 1 : path == ToolPath::kTp5c1 ? 0 : kLowerOfTp6c2;
}

/// Definition of the normal of the path. The paper prints N = +-(R x T), which does not have unit length,
/// because T(u,1) is up to 16 deg away from a right angle to R. The paper does not state the side.
struct NormalReading {
  bool unit = true;
  bool outward = true;
};

/// The cutter at parameter u of a flank, and its derivatives by u (workpiece coordinates, mm).
struct FlankPose {
  double u = 0;
  Eigen::Vector3d tip, tip_du;    // tool tip
  Eigen::Vector3d axis, axis_du;  // R: unit, from the tip to the spindle
  Eigen::Vector3d tangent;        // T: unit, along the curve that is touched; T(u,1) of the top one
  Eigen::Vector3d normal;         // N at the point, as in the measurement
  double generatrix_mm = 0;       // |C1 - C0|
};

/// Tip = C1 + radius * N - length * R: with N(u,1) the analytical flank path of the paper's equations 1 to 3.
/// The cutter touches the surface along the whole generatrix only if the surface is not twisted; the excess
/// cut is computed in tools/part/envelope.h.
FlankPose flank_pose(const RuledSurface& surface, const Cutter& cutter, double u, NormalReading reading = {});

}  // namespace vernier::part
