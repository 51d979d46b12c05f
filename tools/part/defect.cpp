// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/defect.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "tools/model/chain/chain_rows.h"
#include "tools/part/surface/s_part.h"

namespace vernier::part {
namespace {

/// Joint poses of points of both flanks, in the order of the points.
std::vector<JointPose> joints_of(const BHeadMachine& machine, const std::vector<PartPoint>& points,
                                 const DefectOptions& options) {
  std::vector<JointPose> joints(points.size());
  for (std::size_t flank = 0; flank < s_part().size(); ++flank) {
    std::vector<double> u;
    for (const PartPoint& point : points)
      if (point.flank == flank) u.push_back(point.u);
    std::sort(u.begin(), u.end());
    u.erase(std::unique(u.begin(), u.end()), u.end());
    if (u.empty()) continue;
    const std::vector<JointPose> path =
        joint_path(s_part()[flank], options.cutter, u, machine.pivot_mm, options.solution);
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i].flank == flank)
        joints[i] =
            path[static_cast<std::size_t>(std::lower_bound(u.begin(), u.end(), points[i].u) - u.begin())];
  }
  return joints;
}

/// Where along which direction the tool's displacement counts.
struct Probe {
  Eigen::Vector3d position;  // of the surface
  Eigen::Vector3d along;     // unit normal of the reading
  double height_mm = 0;      // above the tip, along the axis
};

Probe probe_of(const PartPoint& point, const DefectOptions& options) {
  const RuledSurface& surface = s_part()[point.flank];
  const FlankPose pose = flank_pose(surface, options.cutter, point.u);
  const SurfacePoint at = surface_point(surface, point.u, point.v);
  if (options.reading == DefectReading::kTip) return {at.position, pose.normal, 0};
  // A rotation about the axis moves no cylinder: the point of the axis beside the contact is used.
  Eigen::Vector3d along = at.normal;
  if (options.reading == DefectReading::kInPlane) {
    along.z() = 0;
    along.normalize();
  }
  return {at.position, along, pose.axis.dot(at.position - pose.tip)};
}

/// The statics that a fit may change, as keys of the chain's derivatives.
std::vector<char> active_keys(const model::Machine& machine) {
  std::vector<char> active(machine.statics.size() + 6 * machine.axes.size(), 0);
  for (const std::size_t index : free_statics(machine)) active[index] = 1;
  return active;
}

}  // namespace

std::vector<std::size_t> free_statics(const model::Machine& machine) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < machine.statics.size(); ++i)
    if (!machine.statics[i].hidden) indices.push_back(i);
  return indices;
}

std::vector<ToolDisplacement> displacements(const BHeadMachine& machine, const std::vector<JointPose>& joints,
                                            const std::vector<double>& height_mm) {
  const model::States states = machine.states(joints);
  const model::Machine nominal = model::nominal_machine(machine.machine);
  const model::ChainRows actual(machine.machine, states, active_keys(machine.machine)),
      ideal(nominal, states);
  const std::vector<std::size_t> wanted = free_statics(machine.machine);
  std::vector<ToolDisplacement> result(joints.size());
  std::vector<model::Twist> twists;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const model::Frame here = actual.pose(i, twists), there = ideal.pose(i);
    const Eigen::Vector3d arm = height_mm[i] * here.rotation.col(2);
    result[i].shift = here.origin - there.origin + (arm - height_mm[i] * there.rotation.col(2));
    // A chain need not use every static: entries without a derivative are zero.
    result[i].by = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(wanted.size()));
    for (std::size_t k = 0; k < twists.size(); ++k) {
      const auto at = std::find(wanted.begin(), wanted.end(), actual.keys()[k]) - wanted.begin();
      result[i].by.col(at) = twists[k].point + twists[k].rotation.cross(arm);
    }
  }
  return result;
}

PartDefect part_defect(const BHeadMachine& machine, const std::vector<PartPoint>& points,
                       const DefectOptions& options) {
  PartDefect result;
  result.joints = joints_of(machine, points, options);
  std::vector<Probe> probes;
  std::vector<double> heights_mm;
  for (const PartPoint& point : points) {
    probes.push_back(probe_of(point, options));
    heights_mm.push_back(probes.back().height_mm);
  }
  std::vector<JointPose> with_origin = result.joints;
  with_origin.push_back(machine.origin());
  heights_mm.push_back(0);
  const std::vector<ToolDisplacement> moved = displacements(machine, with_origin, heights_mm);
  const ToolDisplacement& datum = moved.back();
  const auto count = static_cast<Eigen::Index>(points.size());
  result.position.resize(3, count);
  result.normal.resize(3, count);
  result.defect_mm.resize(count);
  result.jacobian.resize(count, datum.by.cols());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Probe& probe = probes[static_cast<std::size_t>(i)];
    const ToolDisplacement& here = moved[static_cast<std::size_t>(i)];
    result.position.col(i) = probe.position;
    result.normal.col(i) = probe.along;
    result.defect_mm[i] = probe.along.dot(here.shift - datum.shift);
    result.jacobian.row(i) = probe.along.transpose() * (here.by - datum.by);
  }
  return result;
}

std::vector<PartPoint> standard_points() {
  std::vector<PartPoint> points;
  for (std::size_t flank = 0; flank < s_part().size(); ++flank)
    for (const double z_mm : kMeasuredHeightsMm)
      for (std::size_t i = 0; i < kPointsPerLine; ++i)
        points.push_back({flank, (static_cast<double>(i) + 0.5) / kPointsPerLine, z_mm / kPartHeightMm});
  return points;
}

}  // namespace vernier::part
