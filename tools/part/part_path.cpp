// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/part_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/maths/factors.h"
#include "tools/part/surface/s_part.h"

namespace vernier::part {
namespace {

constexpr int kSamples = 2000;  // of the curve, among which the fastest is sought
constexpr std::array<const char*, 5> kAxisNames = {"X", "Y", "Z", "B", "C"};

std::array<double, 5> values(const JointPose& q) { return {q.x_mm, q.y_mm, q.z_mm, q.b_deg, q.c_deg}; }

double fastest_mm(const Spline& curve) {
  double fastest = 0;
  for (int i = 0; i <= kSamples; ++i)
    fastest = std::max(fastest, curve.at(static_cast<double>(i) / kSamples).first.norm());
  return fastest;
}

/// A thousandth of the finest step of any axis here; -0 as 0.
std::string fixed(double value, int digits) {
  const std::string text = fmt::format("{:.{}f}", value, digits);
  return text.find_first_not_of("-0.") == std::string::npos && text[0] == '-' ? text.substr(1) : text;
}

}  // namespace

PartPath part_path(const BHeadMachine& machine, std::size_t flank, const PathOptions& options) {
  const RuledSurface& surface = s_part()[flank];
  const auto steps = static_cast<std::size_t>(std::ceil(fastest_mm(surface.top) / options.step_mm));
  PartPath path;
  path.flank = flank;
  Eigen::Vector3d before = surface.top.at(0).position;
  double length_mm = 0;
  for (std::size_t i = 0; i <= steps; ++i) {
    path.u.push_back(static_cast<double>(i) / static_cast<double>(steps));
    const Eigen::Vector3d here = surface.top.at(path.u.back()).position;
    path.step_mm = std::max(path.step_mm, (here - before).norm());
    length_mm += (here - before).norm();
    before = here;
    path.t_s.push_back(length_mm / options.feed_mm_min * maths::kSecondsPerMinute);
  }
  path.chord_error_mm = path.step_mm * path.step_mm / (8 * options.cutter.radius_mm);
  path.joints = joint_path(surface, options.cutter, path.u, machine.pivot_mm, options.solution);
  return path;
}

std::string path_csv(const BHeadMachine& machine, const PartPath& path) {
  std::string text = fmt::format("# S-shaped test part, flank {}, step {:.4g} mm\nt[s]",
                                 s_part()[path.flank].name, path.step_mm);
  for (std::size_t k = 0; k < 5; ++k)
    text +=
        fmt::format(",{}[{}]", kAxisNames[k], machine.machine.axes[machine.axis[k]].rotary ? "deg" : "mm");
  text += '\n';
  for (std::size_t i = 0; i < path.u.size(); ++i) {
    text += fixed(path.t_s[i], 6);
    for (const double value : values(path.joints[i])) text += "," + fixed(value, 7);
    text += '\n';
  }
  return text;
}

std::string path_gcode(const PartPath& path, const PathOptions& options) {
  std::string text = fmt::format(
      "(S-shaped test part, flank {}: cutter radius {:g} mm, length {:g} mm, feed {:g} mm/min on the top "
      "curve)\n(axis positions, B axis to tool tip included; inverse-time feed)\nG21 G90 G94\n",
      s_part()[path.flank].name, options.cutter.radius_mm, options.cutter.length_mm, options.feed_mm_min);
  for (std::size_t i = 0; i < path.u.size(); ++i) {
    if (i == 1) text += "G93\n";
    text += i == 0 ? "G0" : "G1";
    for (std::size_t k = 0; k < 5; ++k)
      text += fmt::format(" {}{}", kAxisNames[k], fixed(values(path.joints[i])[k], 5));
    if (i > 0) text += fmt::format(" F{:.4f}", maths::kSecondsPerMinute / (path.t_s[i] - path.t_s[i - 1]));
    text += '\n';
  }
  return text + "G94\nM2\n";
}

std::string defect_csv(const std::vector<PartPoint>& points, const PartDefect& defect) {
  std::string text =
      "flank,u_curve,sx[mm],sy[mm],sz[mm],nx,ny,nz,defect[mm],X[mm],Y[mm],Z[mm],B[deg],C[deg]\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    text += fmt::format("{},{}", s_part()[points[i].flank].name, fixed(points[i].u, 6));
    for (const double value : defect.position.col(row)) text += "," + fixed(value, 6);
    for (const double value : defect.normal.col(row)) text += "," + fixed(value, 9);
    text += "," + fixed(defect.defect_mm[row], 9);
    for (const double value : values(defect.joints[i])) text += "," + fixed(value, 7);
    text += '\n';
  }
  return text;
}

std::vector<std::string> beyond_limits(const BHeadMachine& machine, const PartPath& path) {
  std::vector<std::string> beyond;
  for (std::size_t k = 0; k < 5; ++k) {
    const model::Axis& axis = machine.machine.axes[machine.axis[k]];
    double low = values(path.joints.front())[k], high = low;
    for (const JointPose& q : path.joints) {
      low = std::min(low, values(q)[k]);
      high = std::max(high, values(q)[k]);
    }
    const char* unit = axis.rotary ? "deg" : "mm";
    if (axis.max && high > *axis.max)
      beyond.push_back(fmt::format("{} {:.2f} {} is beyond max {:g}", axis.name, high, unit, *axis.max));
    if (axis.min && low < *axis.min)
      beyond.push_back(fmt::format("{} {:.2f} {} is beyond min {:g}", axis.name, low, unit, *axis.min));
  }
  return beyond;
}

void check_cutter(const RuledSurface& surface, const Cutter& cutter) {
  for (int i = 0; i <= kSamples; ++i) {
    const FlankPose pose = flank_pose(surface, cutter, static_cast<double>(i) / kSamples);
    if (cutter.length_mm < pose.generatrix_mm)
      throw text::InputError(
          {"--tool-length", 0}, fmt::format("{:g}", cutter.length_mm),
          fmt::format("the cutter must not be shorter than the flank, {:.4g} mm at u = {:.4f}",
                      pose.generatrix_mm, pose.u));
    // At the bottom and at the top of the flank the cutter's axis must move forward.
    for (const double v : {0.0, 1.0}) {
      const double h_mm = cutter.length_mm - (1 - v) * pose.generatrix_mm;
      if ((pose.tip_du + h_mm * pose.axis_du).dot(pose.tangent) > 0) continue;
      throw text::InputError({"--tool-diameter", 0}, fmt::format("{:g}", 2 * cutter.radius_mm),
                             fmt::format("the cutter is too thick for the hollow of flank {} at u = {:.4f}",
                                         surface.name, pose.u));
    }
  }
}

}  // namespace vernier::part
