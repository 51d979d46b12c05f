// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>

#include "tools/part/surface/spline.h"

namespace vernier::part {

/// One flank of the test part: straight lines that connect a bottom and a top curve at the same parameter.
/// The points of a flank are S(u,v) = (1-v) C0(u) + v C1(u), with u and v 0..1, mm in workpiece coordinates.
struct RuledSurface {
  char name = '?';
  Spline bottom, top;
  /// +1 or -1. The normal outward * (generatrix x direction of increasing u) points away from the material.
  double outward = 1;
};

struct SurfacePoint {
  Eigen::Vector3d position, by_u, by_v;  // mm, mm per unit of u, v
  Eigen::Vector3d normal;                // unit vector, outward
};

SurfacePoint surface_point(const RuledSurface& surface, double u, double v);

/// Foot point: the point of a surface that is nearest to a point in space.
struct SurfaceFoot {
  double u = 0, v = 0;
  double distance_mm = 0;   // distance along the outward normal; negative: inside the material (overcut)
  double across_mm = 0;     // offset of the point in space beyond an end of the curve
  bool beyond_end = false;  // true: u was limited to 0 or 1
};

/// Returns the nearest point of the surface by Gauss-Newton iteration from (u, v), with 0 <= u <= 1 and v
/// without limits. `point`: coordinates in mm. Throws std::runtime_error if the iteration does not converge,
/// because the start is farther away than the radius of the curve.
SurfaceFoot nearest(const RuledSurface& surface, const Eigen::Vector3d& point, double u, double v);

/// Finds the nearest point of a surface. The start of the iteration is found by a search over the whole
/// surface.
SurfaceFoot nearest(const RuledSurface& surface, const Eigen::Vector3d& point);

}  // namespace vernier::part
