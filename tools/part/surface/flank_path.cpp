// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/surface/flank_path.h"

#include <Eigen/Geometry>

namespace vernier::part {
namespace {

/// A direction and how it turns.
struct Direction {
  Eigen::Vector3d unit, by_u;
  double length;
};

Direction direction(const Eigen::Vector3d& vector, const Eigen::Vector3d& vector_du) {
  const double length = vector.norm();
  const Eigen::Vector3d unit = vector / length;
  return {unit, (vector_du - unit * unit.dot(vector_du)) / length, length};
}

}  // namespace

FlankPose flank_pose(const RuledSurface& surface, const Cutter& cutter, double u, NormalReading reading) {
  const CurvePoint c0 = surface.bottom.at(u), c1 = surface.top.at(u);
  const Direction axis = direction(c1.position - c0.position, c1.first - c0.first);
  const double v = cutter.touch;
  const Direction tangent = direction((1 - v) * c0.first + v * c1.first, (1 - v) * c0.second + v * c1.second);
  const double sign = reading.outward ? surface.outward : -surface.outward;
  Eigen::Vector3d normal = sign * axis.unit.cross(tangent.unit);
  Eigen::Vector3d normal_du = sign * (axis.by_u.cross(tangent.unit) + axis.unit.cross(tangent.by_u));
  if (reading.unit) {
    const Direction unit = direction(normal, normal_du);
    normal = unit.unit;
    normal_du = unit.by_u;
  }
  FlankPose pose;
  pose.u = u;
  pose.axis = axis.unit;
  pose.axis_du = axis.by_u;
  pose.tangent = tangent.unit;
  pose.normal = normal;
  pose.generatrix_mm = axis.length;
  pose.tip = c1.position + cutter.radius_mm * normal - cutter.length_mm * axis.unit;
  pose.tip_du = c1.first + cutter.radius_mm * normal_du - cutter.length_mm * axis.by_u;
  return pose;
}

}  // namespace vernier::part
