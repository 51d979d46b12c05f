// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/surface/s_part.h"

#include <Eigen/Geometry>
#include <vector>

#include "tools/part/surface/ruled_surface.h"

namespace vernier::part {
namespace {

// Control points x, y in mm as the paper's table 1 prints them, in the order of the program; z is 0 at the
// bottom and 30 mm at the top. Two rows of N and M that the print lost follow from table 2, whose points lie
// on the straight lines between them.
using PlanePoints = std::array<std::array<double, 2>, 16>;

constexpr PlanePoints kBottomA = {{{-137, -95.5},
                                   {-134, -41},
                                   {-138, 23},
                                   {-118, 87},
                                   {-49, 84},
                                   {-23, 58},
                                   {-11, 10},
                                   {-9, 2},
                                   {-7, -6},
                                   {-5, -14},
                                   {3, -46},
                                   {36, -88},
                                   {111, -84},
                                   {119, -13},
                                   {118, 43},
                                   {121, 99.5}}};  // curve Q, Z0
constexpr PlanePoints kTopA = {{{-131, -95.5},
                                {-126, -41},
                                {-131, 23},
                                {-116, 78},
                                {-51, 77},
                                {-20, 46},
                                {-11, 10},
                                {-9, 2},
                                {-7, -6},
                                {-5, -14},
                                {3, -46},
                                {32, -80},
                                {103, -81},
                                {116, -13},
                                {110, 43},
                                {115, 99.5}}};  // curve P, Z30
constexpr PlanePoints kBottomB = {{{-127, -95.5},
                                   {-124, -29},
                                   {-128, 30},
                                   {-108, 76},
                                   {-62, 74},
                                   {-33, 56},
                                   {-22, 12},
                                   {-20, 4},
                                   {-18, -4},
                                   {-16, -12},
                                   {-7, -48},
                                   {30, -95},
                                   {100, -97},
                                   {132, -46},
                                   {127, 27},
                                   {131, 99.5}}};  // curve N, Z0
constexpr PlanePoints kTopB = {{{-121, -95.5},
                                {-117, -29},
                                {-121, 30},
                                {-107, 68},
                                {-62, 67},
                                {-31, 48},
                                {-22, 12},
                                {-20, 4},
                                {-18, -4},
                                {-16, -12},
                                {-7, -48},
                                {26, -88},
                                {95, -91},
                                {129, -42},
                                {118, 28},
                                {125, 99.5}}};  // curve M, Z30

Spline curve_at(const PlanePoints& plane, double z_mm) {
  std::vector<Eigen::Vector3d> control;
  for (const auto& [x, y] : plane) control.emplace_back(x, y, z_mm);
  return Spline(control);
}

/// Sign that makes generatrix x tangent point away from the other flank, seen in the middle of the part.
double outward_sign(const RuledSurface& surface, const RuledSurface& other) {
  const SurfacePoint here = surface_point(surface, 0.5, 1);
  double best_mm = -1;
  Eigen::Vector3d towards = Eigen::Vector3d::Zero();
  for (int i = 0; i <= 2000; ++i) {
    const Eigen::Vector3d offset = other.top.at(i / 2000.0).position - here.position;
    if (best_mm >= 0 && offset.norm() >= best_mm) continue;
    best_mm = offset.norm();
    towards = offset;
  }
  return here.by_v.cross(here.by_u).dot(towards) > 0 ? -1 : 1;
}

std::array<RuledSurface, 2> make_s_part() {
  std::array<RuledSurface, 2> part = {
      RuledSurface{'A', curve_at(kBottomA, 0), curve_at(kTopA, kPartHeightMm)},
      RuledSurface{'B', curve_at(kBottomB, 0), curve_at(kTopB, kPartHeightMm)}};
  part[0].outward = outward_sign(part[0], part[1]);
  part[1].outward = outward_sign(part[1], part[0]);
  return part;
}

}  // namespace

const std::array<RuledSurface, 2>& s_part() {
  static const std::array<RuledSurface, 2> part = make_s_part();
  return part;
}

}  // namespace vernier::part
