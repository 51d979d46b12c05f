// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/model/artefact.h"

namespace vernier::model {

/// Position, direction and radius of a touched object (unknown point or artefact). The columns of `axes` are
/// two perpendicular directions, and then the direction of a line or axis, or the normal of a plane. All
/// lengths are in mm, in the frame of the object.
struct ThingShape {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double radius = 0;
};

/// Vector of the unknown values of one object. The vector of one object has at most six values: three of a
/// position, two of a direction, one radius.
using ThingUnknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// Returns the number of unknown values of a touched object, 0 to 6. The order of the unknown values is:
/// position (3 for a point and a sphere, 2 across a line or an axis, 1 along a normal), tilt about the two
/// perpendicular directions (rad), radius.
Eigen::Index unknowns_of(const Artefact& artefact);

/// One reading of a touch.
struct TouchReading {
  double value = 0;          // distance of the tool point from the object, mm; 0: the tool point is on the
                             // object
  Eigen::Vector3d by_point;  // derivative of the distance by the tool point
  ThingUnknowns by_unknown;  // derivative of the distance by the unknown values, mm/mm and mm/rad
  double by_tip = 0;         // derivative of the distance by the radius of the tip
};

/// Returns the reading `component` (from 0) of a touch at `point`, mm; `tip`: radius of the tip, mm.
TouchReading touch(const Artefact& artefact, const ThingShape& shape, const Eigen::Vector3d& point,
                   double tip, std::size_t component);

/// Changes the unknown values of a touched object by a step.
void move_thing(const Artefact& artefact, const ThingUnknowns& step, ThingShape& shape);

/// Returns the directions of the unknown coordinates of an object's position, as columns in the order of the
/// unknown values.
Eigen::Matrix3Xd place_directions(const Artefact& artefact, const ThingShape& shape);

/// Values of an object that are known with an uncertainty. `precision`: 1 / u^2 of each value, 0 if it is not
/// known. `off`: known value minus the value of `shape`.
struct KnownValues {
  ThingUnknowns precision, off;
};
KnownValues known_values(const Artefact& artefact, const ThingShape& shape);

/// Returns start values for the shape of a touched object, computed from the tool points at the touches (at
/// least one, mm). The most probable start value is first. `down`: direction of gravity, which selects the
/// side of a spherical cap.
std::vector<ThingShape> thing_starts(const Artefact& artefact, const std::vector<Eigen::Vector3d>& points,
                                     double tip, const Eigen::Vector3d& down);

}  // namespace vernier::model
