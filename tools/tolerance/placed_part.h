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

/// A feature with the machine positions at which its points are cut or touched.
struct PlacedFeature {
  PartFeature feature;
  std::size_t first = 0, count = 0;  // first state of the feature in PlacedPart::states, and number of states
  /// Evaluated direction at each point of the feature: the surface normal. For a path, the stored direction
  /// is the tangent, along which deviations are not evaluated. For a zero vector every direction is
  /// evaluated.
  Eigen::Matrix3Xd direction;
};

/// Machine positions for all points of all features of a part.
struct PlacedPart {
  std::vector<PlacedFeature> features;
  model::States states;
  Eigen::Matrix3Xd point;  // nominal points in workpiece coordinates, mm
  bool program = false;    // true: states with the speeds and reversals of a part program; false: the machine
                           // is at rest at each point
};

/// Returns the number of points at which a circle is evaluated, between 12 and 384. The number starts at 12
/// and is doubled until size and form of the machine's error are stable. Size and form are stable if twice
/// and three times as many points change them by at most 0.05 um or 2 % of the form, whichever is larger.
/// With too few points on the circle, a cyclic error of a short period can appear as an error of the size.
/// `placed` returns the states of n points on the circle and the outward directions at these points.
std::size_t points_on_circle(
    const model::Machine& machine,
    const std::function<std::pair<model::States, Eigen::Matrix3Xd>(std::size_t)>& placed);

/// Distributes points over each feature and computes the axis positions at which the tool of the nominal
/// machine is at each point. A cylinder has three circles with points_on_circle points each, a plane has 5 x
/// 5 points. The directions of motion are those from one point to the next; a circle is traversed
/// counter-clockwise about its axis. `at`: values of the inputs, and positions of the axes that do not move.
/// Throws LimitNotMet with the line of the feature if the machine cannot reach a point.
PlacedPart place_part(const model::Machine& machine, const PartDrawing& part, const model::States& at);

}  // namespace vernier::tolerance
