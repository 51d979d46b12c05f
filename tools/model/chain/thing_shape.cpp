// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/thing_shape.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tools/maths/decompositions.h"

namespace vernier::model {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

/// Which values of a thing are unknown.
struct Layout {
  Index place = 0, tilt = 0, radius = 0;  // number of each
  Index size() const { return place + tilt + radius; }
};

Layout layout_of(const Artefact& a) {
  Layout layout;
  if (!a.place || a.u_place > 0) {
    const bool all = a.type == ArtefactType::kPoint || a.type == ArtefactType::kSphere;
    layout.place = all ? 3 : a.type == ArtefactType::kPlane ? 1 : 2;
  }
  if (a.has_direction() && !a.direction) layout.tilt = 2;
  if (a.has_radius() && (!a.radius || a.u_radius > 0)) layout.radius = 1;
  return layout;
}

/// Returns the direction of each unknown coordinate of the place.
Matrix3d place_axes(const Artefact& a, const ThingShape& shape) {
  Matrix3d axes = shape.axes;
  if (a.type == ArtefactType::kPlane) axes.col(0) = shape.axes.col(2);
  if (!a.has_direction()) axes.setIdentity();
  return axes;
}

/// A right-handed frame whose third axis is `direction`.
Matrix3d frame_about(const Vector3d& direction) {
  Matrix3d axes;
  axes.col(2) = direction.normalized();
  axes.col(0) = axes.col(2).unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

Vector3d mean_of(const Points& points) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Principal directions of the points, by increasing extent.
Matrix3d principal(const Points& points, const Vector3d& mean) {
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(3, 3);
  for (const Vector3d& p : points) spread += (p - mean) * (p - mean).transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(spread).eigenvectors();
}

/// Centre and radius of the sphere (columns = 3) or circle (2) through the points, in the directions of the
/// columns: linear in 2 c and R^2 - c^2 about the mean. The shortest solution if the points do not determine
/// it.
struct Round {
  Vector3d centre = Vector3d::Zero();
  double radius = 0, misfit = 0;
};
Round round_through(const Points& points, const Vector3d& mean, const Eigen::Matrix3Xd& directions) {
  const auto n = static_cast<Index>(points.size()), k = directions.cols();
  Eigen::MatrixXd a(n, k + 1);
  Eigen::VectorXd b(n);
  for (Index i = 0; i < n; ++i) {
    const Eigen::VectorXd q = directions.transpose() * (points[static_cast<std::size_t>(i)] - mean);
    a.row(i).head(k) = 2 * q.transpose();
    a(i, k) = 1;
    b[i] = q.squaredNorm();
  }
  const Eigen::VectorXd x = maths::least_norm(a, b);
  Round round;
  round.centre = mean + directions * x.head(k);
  round.radius = std::sqrt(std::max(0.0, x[k] + x.head(k).squaredNorm()));
  for (const Vector3d& p : points)
    round.misfit += std::pow((directions.transpose() * (p - round.centre)).norm() - round.radius, 2);
  return round;
}

/// Adds the known values of an artefact to a start.
ThingShape with_known(const Artefact& a, ThingShape shape) {
  if (a.place) shape.point = Vector3d(a.place->at(0), a.place->at(1), a.place->at(2));
  if (a.direction)
    shape.axes = frame_about(Vector3d(a.direction->at(0), a.direction->at(1), a.direction->at(2)));
  if (a.radius) shape.radius = *a.radius;
  return shape;
}

void add_spheres(const Artefact& a, const Points& points, double tip, const Vector3d& down,
                 std::vector<ThingShape>& starts) {
  const Vector3d mean = mean_of(points);
  const Round round = round_through(points, mean, Matrix3d::Identity());
  ThingShape shape;
  shape.point = round.centre;
  shape.radius = std::max(0.0, round.radius + (a.inside ? tip : -tip));
  starts.push_back(shape);
  if (!a.radius) return;
  // Touches of a small cap: the centre is a radius below or above them.
  const double reach = *a.radius + (a.inside ? -tip : tip);
  Vector3d normal = principal(points, mean).col(0);
  if (normal.dot(down) < 0) normal = -normal;
  for (const double sense : {a.inside ? -1.0 : 1.0, a.inside ? 1.0 : -1.0}) {
    shape.point = mean + sense * reach * normal;
    starts.push_back(shape);
  }
}

/// Axes all over the half sphere: the touches show the axis only in second order.
void add_cylinders(const Artefact& a, const Points& points, double tip, std::vector<ThingShape>& starts) {
  constexpr int kDirections = 24;  // about 25 degrees apart
  const Vector3d mean = mean_of(points);
  std::vector<Vector3d> axes;
  if (a.direction)
    axes.emplace_back(a.direction->at(0), a.direction->at(1), a.direction->at(2));
  else
    for (const auto& one :
         {Vector3d(Vector3d::UnitX()), Vector3d(Vector3d::UnitY()), Vector3d(Vector3d::UnitZ())})
      axes.push_back(one);
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));  // angle of a spiral of even density
  for (int i = 0; i < kDirections && !a.direction; ++i) {
    const double z = (i + 0.5) / kDirections, side = std::sqrt(1 - z * z);
    axes.emplace_back(side * std::cos(golden * i), side * std::sin(golden * i), z);
  }
  Round best;
  best.misfit = -1;
  ThingShape shape;
  for (const Vector3d& axis : axes) {
    const Matrix3d frame = frame_about(axis);
    const Round round = round_through(points, mean, frame.leftCols<2>());
    if (best.misfit >= 0 && round.misfit >= best.misfit) continue;
    best = round;
    shape.axes = frame;
  }
  shape.point = best.centre;
  shape.radius = std::max(0.0, best.radius + (a.inside ? tip : -tip));
  starts.push_back(shape);
}

}  // namespace

Index unknowns_of(const Artefact& artefact) { return layout_of(artefact).size(); }

TouchReading touch(const Artefact& a, const ThingShape& shape, const Vector3d& point, double tip,
                   std::size_t component) {
  const Layout layout = layout_of(a);
  const Vector3d arm = point - shape.point;
  const Matrix3d& e = shape.axes;
  const auto k = static_cast<Index>(component);
  const double side = a.inside ? -1 : 1;
  TouchReading reading;
  reading.by_unknown = ThingUnknowns::Zero(layout.size());
  if (a.type == ArtefactType::kPoint) {
    reading.value = arm[k];
    reading.by_point = Vector3d::Unit(k);
  } else if (a.type == ArtefactType::kLine) {
    reading.value = e.col(k).dot(arm);
    reading.by_point = e.col(k);
    if (layout.tilt > 0) reading.by_unknown[layout.place + k] = -e.col(2).dot(arm);
  } else if (a.type == ArtefactType::kPlane) {
    reading.value = e.col(2).dot(arm) - tip;
    reading.by_point = e.col(2);
    reading.by_tip = -1;
    for (Index t = 0; t < layout.tilt; ++t) reading.by_unknown[layout.place + t] = e.col(t).dot(arm);
  } else {
    const bool sphere = a.type == ArtefactType::kSphere;
    const Vector3d across = sphere ? arm : Vector3d(arm - e.col(2) * e.col(2).dot(arm));
    const double distance = across.norm();
    reading.value = distance - shape.radius - side * tip;
    reading.by_point = distance > 0 ? Vector3d(across / distance) : Vector3d(e.col(0));
    reading.by_tip = -side;
    for (Index t = 0; t < layout.tilt; ++t)
      reading.by_unknown[layout.place + t] = -e.col(2).dot(arm) * e.col(t).dot(reading.by_point);
    if (layout.radius > 0) reading.by_unknown[layout.place + layout.tilt] = -1;
  }
  const Matrix3d axes = place_axes(a, shape);
  for (Index i = 0; i < layout.place; ++i) reading.by_unknown[i] = -axes.col(i).dot(reading.by_point);
  return reading;
}

void move_thing(const Artefact& a, const ThingUnknowns& step, ThingShape& shape) {
  const Layout layout = layout_of(a);
  const Matrix3d axes = place_axes(a, shape);
  for (Index i = 0; i < layout.place; ++i) shape.point += step[i] * axes.col(i);
  if (layout.tilt > 0) {
    // The rotation vector that moves the direction by step along the two directions across.
    const Vector3d turn = step[layout.place] * shape.axes.col(1) - step[layout.place + 1] * shape.axes.col(0);
    const double angle = turn.norm();
    if (angle > 0) shape.axes = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * shape.axes;
  }
  if (layout.radius > 0) shape.radius += step[layout.place + layout.tilt];
}

Eigen::Matrix3Xd place_directions(const Artefact& a, const ThingShape& shape) {
  return place_axes(a, shape).leftCols(layout_of(a).place);
}

KnownValues known_values(const Artefact& a, const ThingShape& shape) {
  const Layout layout = layout_of(a);
  KnownValues known{ThingUnknowns::Zero(layout.size()), ThingUnknowns::Zero(layout.size())};
  if (layout.place > 0 && a.place) {
    const Matrix3d axes = place_axes(a, shape);
    const Vector3d off = Vector3d(a.place->at(0), a.place->at(1), a.place->at(2)) - shape.point;
    for (Index i = 0; i < layout.place; ++i) {
      known.precision[i] = 1 / (a.u_place * a.u_place);
      known.off[i] = axes.col(i).dot(off);
    }
  }
  if (layout.radius > 0 && a.radius) {
    const Index at = layout.place + layout.tilt;
    known.precision[at] = 1 / (a.u_radius * a.u_radius);
    known.off[at] = *a.radius - shape.radius;
  }
  return known;
}

std::vector<ThingShape> thing_starts(const Artefact& a, const Points& points, double tip,
                                     const Vector3d& down) {
  std::vector<ThingShape> starts;
  if (a.type == ArtefactType::kSphere) {
    add_spheres(a, points, tip, down, starts);
  } else if (a.type == ArtefactType::kCylinder) {
    add_cylinders(a, points, tip, starts);
  } else {
    ThingShape shape;
    shape.point = mean_of(points);
    if (a.has_direction())
      shape.axes = frame_about(principal(points, shape.point).col(a.type == ArtefactType::kPlane ? 0 : 2));
    starts.push_back(shape);
  }
  for (ThingShape& start : starts) start = with_known(a, start);
  return starts;
}

}  // namespace vernier::model
