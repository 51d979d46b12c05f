// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <functional>
#include <utility>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"
#include "tools/tolerance/part_features.h"

namespace vernier::tolerance {

/// A feature at the positions where the machine cuts or touches it.
struct PlacedFeature {
  PartFeature feature;
  std::size_t first = 0, count = 0;  // its states
  /// The evaluated direction at each point: surface normals; for a path its tangent, along which the path is
  /// not evaluated; 0: every direction.
  Eigen::Matrix3Xd direction;
};

/// Positions of the machine for every point of every feature.
struct PlacedPart {
  std::vector<PlacedFeature> features;
  model::States states;
  Eigen::Matrix3Xd point;  // nominal, workpiece coordinates, mm
  bool program = false;    // with speeds and reversals of a part program; else each point at rest
};

/// Number of points on a circle. 12, doubled until size and form of the machine's own error agree with those
/// of twice and three times as many points to 0.05 um or 2 % of the form: with few points, a cyclic error of
/// a short period can appear as an error of the size. At most 384. `placed`: states of n points and their
/// outward directions.
std::size_t points_on_circle(
    const model::Machine& machine,
    const std::function<std::pair<model::States, Eigen::Matrix3Xd>(std::size_t)>& placed);

/// Distributes points over every feature (a cylinder: points_on_circle on each of three circles, a plane: 5 x
/// 5) and computes the axis positions at which the nominal chain has its tool at each point. Directions of
/// motion are those from point to point, a circle counter-clockwise about its axis. `at`: inputs, and the
/// positions of axes that are not needed. Throws LimitNotMet if a point is out of reach, naming the line.
PlacedPart place_part(const model::Machine& machine, const PartDrawing& part, const model::States& at);

}  // namespace vernier::tolerance
