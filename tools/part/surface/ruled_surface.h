// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>

#include "tools/part/surface/spline.h"

namespace vernier::part {

/// One flank of the part: straight lines between a bottom and a top curve at the same parameter. S(u,v) =
/// (1-v) C0(u) + v C1(u), u and v 0..1, mm in workpiece coordinates.
struct RuledSurface {
  char name = '?';
  Spline bottom, top;
  /// +1 or -1: outward normal = outward * (generatrix x direction of growing u), away from the material.
  double outward = 1;
};

struct SurfacePoint {
  Eigen::Vector3d position, by_u, by_v;  // mm, mm per unit of u, v
  Eigen::Vector3d normal;                // unit, outward
};

SurfacePoint surface_point(const RuledSurface& surface, double u, double v);

/// Foot point: the nearest point of a surface to a point in space.
struct SurfaceFoot {
  double u = 0, v = 0;
  double distance_mm = 0;   // along the outward normal; negative: within the material (overcut)
  double across_mm = 0;     // offset of the foot point beyond an end of the curve
  bool beyond_end = false;  // u was held at 0 or 1
};

/// Returns the nearest point of the surface by Gauss-Newton from (u, v), limited to 0 <= u <= 1, v free.
/// point: mm. Throws std::runtime_error if the iteration does not converge (start farther off than the
/// curve's radius).
SurfaceFoot nearest(const RuledSurface& surface, const Eigen::Vector3d& point, double u, double v);

/// Finds the nearest point of a surface; searches the whole surface for the start.
SurfaceFoot nearest(const RuledSurface& surface, const Eigen::Vector3d& point);

}  // namespace vernier::part
