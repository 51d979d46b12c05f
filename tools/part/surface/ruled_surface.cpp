// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/surface/ruled_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vernier::part {
namespace {

constexpr int kMostSteps = 60;              // Gauss and Newton's, at most
constexpr double kSettled = 1e-14;          // of u and v, which are 0..1
constexpr std::size_t kSearchPoints = 400;  // from which the nearest begins

Eigen::Vector2d step_towards(const SurfacePoint& s, const Eigen::Vector3d& offset) {
  const double e = s.by_u.squaredNorm(), f = s.by_u.dot(s.by_v), g = s.by_v.squaredNorm();
  const double a = s.by_u.dot(offset), b = s.by_v.dot(offset), det = e * g - f * f;
  return {(a * g - b * f) / det, (e * b - f * a) / det};
}

}  // namespace

SurfacePoint surface_point(const RuledSurface& surface, double u, double v) {
  const CurvePoint c0 = surface.bottom.at(u), c1 = surface.top.at(u);
  SurfacePoint result;
  result.position = (1 - v) * c0.position + v * c1.position;
  result.by_u = (1 - v) * c0.first + v * c1.first;
  result.by_v = c1.position - c0.position;
  result.normal = surface.outward * result.by_v.cross(result.by_u).normalized();
  return result;
}

SurfaceFoot nearest(const RuledSurface& surface, const Eigen::Vector3d& point, double u, double v) {
  bool settled = false;
  for (int i = 0; i < kMostSteps && !settled; ++i) {
    const SurfacePoint s = surface_point(surface, u, v);
    Eigen::Vector2d step = step_towards(s, point - s.position);
    const double next_u = std::clamp(u + step[0], 0.0, 1.0);
    if (next_u != u + step[0])  // held at an end: v alone moves to its best
      step[1] = s.by_v.dot(point - s.position - (next_u - u) * s.by_u) / s.by_v.squaredNorm();
    settled = std::abs(next_u - u) < kSettled && std::abs(step[1]) < kSettled;
    // Gauss-Newton ends on a cycle of the last bits; a step of that size counts as converged too.
    settled = settled || (i > 20 && std::abs(next_u - u) < 1e-11 && std::abs(step[1]) < 1e-11);
    u = next_u;
    v += step[1];
  }
  if (!settled) throw std::runtime_error("the search for the nearest point of the surface did not converge");
  const SurfacePoint s = surface_point(surface, u, v);
  const Eigen::Vector3d offset = point - s.position;
  SurfaceFoot foot{u, v, offset.dot(s.normal), 0, u <= 0 || u >= 1};
  foot.across_mm = (offset - foot.distance_mm * s.normal).norm();
  return foot;
}

SurfaceFoot nearest(const RuledSurface& surface, const Eigen::Vector3d& point) {
  double best = -1, best_u = 0, best_v = 0;
  for (std::size_t i = 0; i <= kSearchPoints; ++i) {
    const double u = static_cast<double>(i) / kSearchPoints;
    const Eigen::Vector3d foot = surface.bottom.at(u).position;
    const Eigen::Vector3d along = surface.top.at(u).position - foot;
    const double v = std::clamp(along.dot(point - foot) / along.squaredNorm(), 0.0, 1.0);
    const double distance = (point - foot - v * along).norm();
    if (best >= 0 && distance >= best) continue;
    best = distance;
    best_u = u;
    best_v = v;
  }
  return nearest(surface, point, best_u, best_v);
}

}  // namespace vernier::part
