// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/envelope.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace vernier::part {
namespace {

constexpr int kSamplesPerSpan = 40;  // between which a foot is sought
constexpr double kRefinedTo = 1e-9;  // of u
constexpr double kEnd = 1e-6;        // a foot so near an end of u is beyond it

/// Height of a generatrix point above the tip, mm.
double height_mm(const FlankPose& pose, const Cutter& cutter, double v) {
  return cutter.length_mm - (1 - v) * pose.generatrix_mm;
}

Eigen::Vector3d velocity(const FlankPose& pose, double h_mm) { return pose.tip_du + h_mm * pose.axis_du; }

/// Golden-section search of a maximum in low..high (one hump between them).
Worst golden(const std::function<double(double)>& f, double low, double high) {
  const double share = 1 / std::numbers::phi;
  double a = high - share * (high - low), b = low + share * (high - low), fa = f(a), fb = f(b);
  while (high - low > kRefinedTo) {
    if (fa > fb) {
      high = b;
      b = a;
      fb = fa;
      fa = f(a = high - share * (high - low));
    } else {
      low = a;
      a = b;
      fa = fb;
      fb = f(b = low + share * (high - low));
    }
  }
  return {std::max(fa, fb), fa > fb ? a : b};
}

Worst worst(const std::function<double(double)>& f, std::size_t spans) {
  const int count = static_cast<int>(spans) * kSamplesPerSpan;
  Worst result{f(0), 0};
  for (int i = 1; i <= count; ++i) {
    const double u = static_cast<double>(i) / count;
    if (const double value = f(u); value > result.value_mm) result = {value, u};
  }
  const double step = 1.0 / count, at = result.u;
  // Either side for itself: the sample may be a knot, where the slope jumps.
  for (const auto& [low, high] : {std::pair{at - step, at}, std::pair{at, at + step}})
    if (low >= 0 && high <= 1)
      if (const Worst refined = golden(f, low, high); refined.value_mm > result.value_mm) result = refined;
  return result;
}

}  // namespace

EnvelopePoint envelope_point(const FlankPose& pose, const Cutter& cutter, double v) {
  const double h_mm = height_mm(pose, cutter, v);
  Eigen::Vector3d normal = pose.axis.cross(velocity(pose, h_mm)).normalized();
  if (normal.dot(pose.normal) < 0) normal = -normal;
  return {pose.tip + h_mm * pose.axis - cutter.radius_mm * normal, normal};
}

double overcut_formula_mm(const FlankPose& pose, const Cutter& cutter, double v) {
  const Eigen::Vector3d speed = velocity(pose, height_mm(pose, cutter, v));
  const double theta = std::atan2(-speed.dot(pose.tangent), speed.dot(pose.normal));
  return cutter.radius_mm * (1 - std::abs(std::sin(theta)));
}

double envelope_distance_mm(const RuledSurface& surface, const Cutter& cutter, double u, double v,
                            NormalReading reading) {
  const EnvelopePoint point = envelope_point(flank_pose(surface, cutter, u, reading), cutter, v);
  const SurfaceFoot foot = nearest(surface, point.position, u, v);
  return foot.u < kEnd || foot.u > 1 - kEnd ? 0 : foot.distance_mm;
}

Worst worst_formula(const RuledSurface& surface, const Cutter& cutter, double v, NormalReading reading) {
  return worst(
      [&](double u) { return overcut_formula_mm(flank_pose(surface, cutter, u, reading), cutter, v); },
      surface.top.spans());
}

Worst worst_distance(const RuledSurface& surface, const Cutter& cutter, double v, NormalReading reading) {
  return worst([&](double u) { return -envelope_distance_mm(surface, cutter, u, v, reading); },
               surface.top.spans());
}

}  // namespace vernier::part
