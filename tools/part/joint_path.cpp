// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/joint_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/maths/factors.h"

namespace vernier::part {
namespace {

constexpr double kPi = std::numbers::pi;
/// Horizontal part of the tool axis below which C cannot be computed: rounding is 1e-16, and C is still right
/// to 1e-7 rad at this limit.
constexpr double kVertical = 1e-9;
constexpr int kGridPerSpan = 40;

struct Rotary {
  double b_rad = 0, c_rad = 0;
  bool free = false;  // the tool is vertical, C is not determined
};

Rotary principal(const Eigen::Vector3d& axis) {
  const double level = std::hypot(axis.x(), axis.y());
  if (level < kVertical) return {0, 0, true};
  return {std::atan2(level, axis.z()), std::atan2(-axis.y(), axis.x()), false};
}

/// Adds half turns so that C follows `before`; an odd number of them changes the sign of B.
void follow(Rotary& here, double before_rad, bool whole_turns) {
  const double step = whole_turns ? 2 * kPi : kPi;
  const double count = std::round((before_rad - here.c_rad) / step);
  here.c_rad += count * step;
  if (!whole_turns && std::remainder(count, 2.0) != 0) here.b_rad = -here.b_rad;
}

/// C in stretches where it is free: evenly between the neighbours, constant at the ends of the path.
void fill_free(std::vector<Rotary>& path) {
  for (std::size_t i = 0; i < path.size();) {
    if (!path[i].free) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < path.size() && path[end].free) ++end;
    const double from = i > 0 ? path[i - 1].c_rad : end < path.size() ? path[end].c_rad : 0;
    const double to = end < path.size() ? path[end].c_rad : from;
    const auto gap = static_cast<double>(end - i + 1);
    for (std::size_t k = i; k < end; ++k)
      path[k].c_rad = from + (to - from) * static_cast<double>(k - i + 1) / gap;
    i = end;
  }
}

/// The other solution, half a turn away, if it needs smaller angles of the table.
void choose_smaller(std::vector<Rotary>& path) {
  const auto [low, high] = std::minmax_element(
      path.begin(), path.end(), [](const Rotary& a, const Rotary& b) { return a.c_rad < b.c_rad; });
  const double turns = std::round((low->c_rad + high->c_rad) / 2 / kPi);
  for (Rotary& here : path) {
    here.c_rad -= turns * kPi;
    if (std::remainder(turns, 2.0) != 0) here.b_rad = -here.b_rad;
  }
}

}  // namespace

ToolPose tool_pose(const JointPose& q, double pivot_mm) {
  const double sin_b = std::sin(q.b_deg * maths::kRadPerDeg), cos_b = std::cos(q.b_deg * maths::kRadPerDeg);
  const double sin_c = std::sin(q.c_deg * maths::kRadPerDeg), cos_c = std::cos(q.c_deg * maths::kRadPerDeg);
  const double arm_mm = q.x_mm - pivot_mm * sin_b;
  return {{arm_mm * cos_c + q.y_mm * sin_c, -arm_mm * sin_c + q.y_mm * cos_c, q.z_mm - pivot_mm * cos_b},
          {sin_b * cos_c, -sin_b * sin_c, cos_b}};
}

JointPose joints_for(const ToolPose& pose, double pivot_mm, double b_deg, double c_deg) {
  const double sin_c = std::sin(c_deg * maths::kRadPerDeg), cos_c = std::cos(c_deg * maths::kRadPerDeg);
  return {pose.tip.x() * cos_c - pose.tip.y() * sin_c + pivot_mm * std::sin(b_deg * maths::kRadPerDeg),
          pose.tip.x() * sin_c + pose.tip.y() * cos_c,
          pose.tip.z() + pivot_mm * std::cos(b_deg * maths::kRadPerDeg), b_deg, c_deg};
}

std::vector<JointPose> back_solution(const std::vector<ToolPose>& poses, double pivot_mm,
                                     RotarySolution solution) {
  const bool positive = solution == RotarySolution::kPositiveB;
  std::vector<Rotary> path;
  double before_rad = 0;
  for (const ToolPose& pose : poses) {
    path.push_back(principal(pose.axis));
    if (path.back().free) continue;
    follow(path.back(), before_rad, positive);
    before_rad = path.back().c_rad;
  }
  fill_free(path);
  if (!positive) choose_smaller(path);
  std::vector<JointPose> joints;
  for (std::size_t i = 0; i < path.size(); ++i)
    joints.push_back(
        joints_for(poses[i], pivot_mm, path[i].b_rad / maths::kRadPerDeg, path[i].c_rad / maths::kRadPerDeg));
  return joints;
}

std::vector<JointPose> joint_path(const RuledSurface& surface, const Cutter& cutter,
                                  const std::vector<double>& u, double pivot_mm, RotarySolution solution) {
  const std::size_t spans = surface.top.spans() * kGridPerSpan;
  std::vector<double> grid = u;
  for (std::size_t i = 0; i <= spans; ++i)
    grid.push_back(static_cast<double>(i) / static_cast<double>(spans));
  std::sort(grid.begin(), grid.end());
  grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
  std::vector<ToolPose> poses;
  poses.reserve(grid.size());
  for (const double at : grid) {
    const FlankPose pose = flank_pose(surface, cutter, at);
    poses.push_back({pose.tip, pose.axis});
  }
  const std::vector<JointPose> all = back_solution(poses, pivot_mm, solution);
  std::vector<JointPose> asked;
  asked.reserve(u.size());
  for (const double at : u)
    asked.push_back(
        all[static_cast<std::size_t>(std::lower_bound(grid.begin(), grid.end(), at) - grid.begin())]);
  return asked;
}

}  // namespace vernier::part
