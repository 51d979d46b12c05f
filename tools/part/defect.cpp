#include "tools/part/defect.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "tools/model/chain_rows.h"

namespace vernier {
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
  // A turn about the axis moves no cylinder, so the point of the axis beside the contact stands for it.
  Eigen::Vector3d along = at.normal;
  if (options.reading == DefectReading::kInPlane) {
    along.z() = 0;
    along.normalize();
  }
  return {at.position, along, pose.axis.dot(at.position - pose.tip)};
}

/// The statics that a fit may change, as keys of the chain's derivatives.
std::vector<char> free_statics(const Machine& machine) {
  std::vector<char> active(machine.statics.size() + 6 * machine.axes.size(), 0);
  for (std::size_t i = 0; i < machine.statics.size(); ++i) active[i] = machine.statics[i].hidden ? 0 : 1;
  return active;
}

/// Displacement of the tool at `height_mm` above its tip, and its derivatives by the active keys.
struct Displacement {
  Eigen::Vector3d shift;
  Eigen::Matrix3Xd by;
};

Displacement displacement(const ChainRows& actual, const ChainRows& ideal, std::size_t row,
                          double height_mm) {
  std::vector<Twist> twists;
  const Frame here = actual.pose(row, twists), wanted = ideal.pose(row);
  const Eigen::Vector3d arm = height_mm * here.rotation.col(2);
  Displacement result{here.origin + arm - wanted.origin - height_mm * wanted.rotation.col(2),
                      Eigen::Matrix3Xd(3, static_cast<Eigen::Index>(twists.size()))};
  for (std::size_t k = 0; k < twists.size(); ++k)
    result.by.col(static_cast<Eigen::Index>(k)) = twists[k].point + twists[k].rotation.cross(arm);
  return result;
}

}  // namespace

PartDefect part_defect(const BHeadMachine& machine, const std::vector<PartPoint>& points,
                       const DefectOptions& options) {
  PartDefect result;
  result.joints = joints_of(machine, points, options);
  std::vector<JointPose> with_origin = result.joints;
  with_origin.push_back(machine.origin());
  const States states = machine.states(with_origin);
  const Machine nominal = nominal_machine(machine.machine);
  const ChainRows actual(machine.machine, states, free_statics(machine.machine)), ideal(nominal, states);
  result.parameters = actual.keys();
  const auto count = static_cast<Eigen::Index>(points.size());
  result.position.resize(3, count);
  result.normal.resize(3, count);
  result.defect_mm.resize(count);
  result.jacobian.resize(count, static_cast<Eigen::Index>(result.parameters.size()));
  const Displacement datum = displacement(actual, ideal, points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Probe probe = probe_of(points[i], options);
    const Displacement moved = displacement(actual, ideal, i, probe.height_mm);
    result.position.col(row) = probe.position;
    result.normal.col(row) = probe.along;
    result.defect_mm[row] = probe.along.dot(moved.shift - datum.shift);
    result.jacobian.row(row) = probe.along.transpose() * (moved.by - datum.by);
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

}  // namespace vernier
