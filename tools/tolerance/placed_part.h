// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
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
};

/// Distributes points over every feature (a cylinder: 12 on each of three circles, a plane: 5 x 5) and
/// computes the axis positions at which the nominal chain has its tool at each point. Directions of motion
/// are those from point to point, a circle counter-clockwise about its axis. `at`: inputs, and the positions
/// of axes that are not needed. Throws LimitNotMet if a point is out of reach, naming the line. tool.
PlacedPart place_part(const model::Machine& machine, const PartDrawing& part, const model::States& at);

}  // namespace vernier::tolerance
