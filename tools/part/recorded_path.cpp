// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/recorded_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/maths/factors.h"
#include "tools/maths/golden.h"
#include "tools/part/part_column.h"
#include "tools/part/surface/s_part.h"

namespace vernier::part {
namespace {

using Eigen::Vector3d;

constexpr double kReachMm = 1;  // beyond it the cutter does not cut at the point
constexpr int kSections = 40;   // of a step; 1e-8 of it

JointPose between(const JointPose& a, const JointPose& b, double share) {
  const auto mix = [&](double from, double to) { return from + share * (to - from); };
  return {mix(a.x_mm, b.x_mm), mix(a.y_mm, b.y_mm), mix(a.z_mm, b.z_mm), mix(a.b_deg, b.b_deg),
          mix(a.c_deg, b.c_deg)};
}

/// Position of the cutter's cylinder along the normal of a point, mm. Not a number if it is out of reach or
/// below the tip.
double reached_mm(const ToolPose& tool, double radius_mm, const SurfacePoint& at) {
  const Vector3d from = at.position - tool.tip;
  const Vector3d off = from - tool.axis * tool.axis.dot(from),
                 along = at.normal - tool.axis * tool.axis.dot(at.normal);
  const double a = along.squaredNorm(), b = off.dot(along), c = off.squaredNorm() - radius_mm * radius_mm;
  const double reached = (-b - std::sqrt(b * b - a * c)) / a;
  const bool above_tip = tool.axis.dot(from + reached * at.normal) >= 0;
  return std::abs(reached) < kReachMm && above_tip ? reached : std::numeric_limits<double>::quiet_NaN();
}

/// Least of a function near a place, where not a number is far.
template <typename Function>
double least_between(const Function& value, double low, double high) {
  const auto depth = [&](double at) {
    const double one = value(at);
    return std::isnan(one) ? -kReachMm : -one;
  };
  return -maths::golden_peak(depth, low, high, kSections).value;
}

/// Residual of the programmed path of the flank at a point: the pose at its u does not cut deepest there; a
/// pose near it does.
double programmed_mm(const PartPoint& point, const SurfacePoint& at, const Cutter& cutter) {
  constexpr double kNear = 0.003;  // of u: 2 mm, where the contact is 0.55 mm off at most
  const auto value = [&](double u) {
    const FlankPose pose = flank_pose(s_part()[point.flank], cutter, u);
    return reached_mm({pose.tip, pose.axis}, cutter.radius_mm, at);
  };
  return least_between(value, std::max(point.u - kNear, 0.0), std::min(point.u + kNear, 1.0));
}

struct Stretch {
  double least = std::numeric_limits<double>::infinity(), largest = -least, squares = 0;

  void take(double value) {
    least = std::min(least, value), largest = std::max(largest, value), squares += value * value;
  }
  nlohmann::ordered_json json(std::size_t count) const {
    return {{"min_mm", least},
            {"max_mm", largest},
            {"rms_um", maths::kUmPerMm * std::sqrt(squares / static_cast<double>(count))}};
  }
};

}  // namespace

RecordedPath read_recorded(const std::string& text, const std::string& file, const JointPose& zero) {
  const format::CsvFile csv = format::parse_csv(text, file);
  const auto column = [&](const char* name, format::Dimension dimension) {
    return PartColumn(csv, name, dimension, true);
  };
  const PartColumn x = column("X", format::Dimension::kLength), y = column("Y", format::Dimension::kLength),
                   z = column("Z", format::Dimension::kLength), b = column("B", format::Dimension::kAngle),
                   c = column("C", format::Dimension::kAngle);
  RecordedPath path{file, {}};
  for (std::size_t row = 0; row < csv.rows.size(); ++row)
    path.joints.push_back({x.at(row) - zero.x_mm, y.at(row) - zero.y_mm, z.at(row) - zero.z_mm,
                           b.at(row) - zero.b_deg, c.at(row) - zero.c_deg});
  if (path.joints.size() < 2)
    throw text::InputError({file, csv.header_line}, "X", "a path needs at least two rows");
  return path;
}

RecordedDeviations recorded_deviations(const BHeadMachine& machine, const RecordedPath& recorded,
                                       const std::vector<PartPoint>& points, const Cutter& cutter) {
  std::vector<ToolPose> poses;
  poses.reserve(recorded.joints.size());
  for (const JointPose& q : recorded.joints) poses.push_back(tool_pose(q, machine.pivot_mm));
  RecordedDeviations result{recorded.file, {}};
  for (const PartPoint& point : points) {
    const SurfacePoint at = surface_point(s_part()[point.flank], point.u, point.v);
    RecordedPoint found;
    double deepest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double here = reached_mm(poses[i], cutter.radius_mm, at);
      if (here < deepest) deepest = here, found.sample = i;
    }
    if (!std::isfinite(deepest))
      throw text::InputError(
          {recorded.file, 0},
          fmt::format("({:.3f}, {:.3f}, {:.3f})", at.position.x(), at.position.y(), at.position.z()),
          "no recorded position has the cutter within 1 mm of this point of the part: another part, zero or "
          "tool?");
    const auto value = [&](double place) {
      const auto i = static_cast<std::size_t>(place);
      const JointPose& from = recorded.joints[std::min(i, poses.size() - 2)];
      const JointPose& to = recorded.joints[std::min(i + 1, poses.size() - 1)];
      const double share = place - static_cast<double>(std::min(i, poses.size() - 2));
      return reached_mm(tool_pose(between(from, to, share), machine.pivot_mm), cutter.radius_mm, at);
    };
    const auto middle = static_cast<double>(found.sample), last = static_cast<double>(poses.size() - 1);
    // Either side for itself: at a sample the slope jumps.
    found.recorded_mm = std::min({deepest, least_between(value, std::max(middle - 1, 0.0), middle),
                                  least_between(value, middle, std::min(middle + 1, last))});
    found.path_mm = programmed_mm(point, at, cutter);
    result.points.push_back(found);
  }
  return result;
}

nlohmann::ordered_json recorded_json(const RecordedDeviations& deviations) {
  Stretch recorded, path, controller;
  for (const RecordedPoint& point : deviations.points)
    recorded.take(point.recorded_mm), path.take(point.path_mm), controller.take(point.controller_mm());
  const std::size_t count = deviations.points.size();
  return {{"file", deviations.file},
          {"points", count},
          {"recorded", recorded.json(count)},
          {"path", path.json(count)},
          {"controller", controller.json(count)}};
}

std::string recorded_csv(const std::vector<PartPoint>& points, const PartDefect& defect,
                         const RecordedDeviations& deviations) {
  std::string text =
      "flank,u_curve,sx[mm],sy[mm],sz[mm],recorded[mm],path[mm],controller[mm],machine[mm],together[mm],"
      "sample\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const RecordedPoint& point = deviations.points[i];
    const auto row = static_cast<Eigen::Index>(i);
    const Vector3d at = defect.position.col(row);
    text += fmt::format("{},{:.6f},{:.6f},{:.6f},{:.6f},{:.7f},{:.7f},{:.7f},{:.7f},{:.7f},{}\n",
                        s_part()[points[i].flank].name, points[i].u, at.x(), at.y(), at.z(),
                        point.recorded_mm, point.path_mm, point.controller_mm(), defect.defect_mm[row],
                        point.recorded_mm + defect.defect_mm[row], point.sample);
  }
  return text;
}

}  // namespace vernier::part
