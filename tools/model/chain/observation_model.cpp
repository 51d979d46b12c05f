// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/observation_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/maths/factors.h"

namespace vernier::model {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Returns the rotation vector of a rotation, rad. Near half a turn there are two. The one nearest
/// to `like` is used.
Vector3d nearest_rotation_vector(const Matrix3d& rotation, const Vector3d& like) {
  const Eigen::AngleAxisd turn(rotation);
  const Vector3d vector = turn.angle() * turn.axis();
  const double angle = vector.norm();
  if (angle < 1e-9) return vector;
  const Vector3d other = vector * (1 - 2 * std::numbers::pi / angle);
  return (other - like).norm() < (vector - like).norm() ? other : vector;
}

/// d(rotation vector) = this * (small rotation applied from the left). Inverse left Jacobian of SO(3);
/// Chirikjian, Stochastic Models, Information Theory, and Lie Groups, vol. 2, section 10.4.
Matrix3d inverse_left_jacobian(const Vector3d& phi) {
  const double angle = phi.norm();
  const Matrix3d k = cross_matrix(phi);
  if (angle < 1e-4) return Matrix3d::Identity() - 0.5 * k + k * k / 12;
  const double factor = 1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
  return Matrix3d::Identity() - 0.5 * k + factor * k * k;
}

struct ValueAndSlope {
  double value = 0, slope = 0;
};
/// acos(x) / sqrt(1 - x^2), 1 at x = 1. It is the angle between two directions divided by its
/// sine, as a function of its cosine.
ValueAndSlope angle_over_sine(double x) {
  constexpr double kNear = 1e-8;  // below, a series: 1 + (1 - x)/3
  x = std::clamp(x, -1 + 1e-12, 1.0);
  if (1 - x < kNear) return {1 + (1 - x) / 3, -1.0 / 3};
  const double square = 1 - x * x, value = std::acos(x) / std::sqrt(square);
  return {value, (x * value - 1) / square};
}

/// Returns the column of the measured direction's frame for a1 and a2, of the tool's frame for ix
/// and iy.
int across(ObservationKind kind) { return kind == ObservationKind::kA1 ? 1 : 2; }
int level(ObservationKind kind) { return kind == ObservationKind::kIx ? 0 : 1; }

int component(ObservationKind kind) {
  return static_cast<int>(kind) - static_cast<int>(ObservationKind::kRx);
}

}  // namespace

ObservationModel::ObservationModel(const Measurement& measurement, const std::array<double, 3>& gravity,
                                   const BaseShift* shift, const Frame& pose)
    : m_(measurement), pose_(pose), up_(-gravity[0], -gravity[1], -gravity[2]) {
  if (shift != nullptr) {
    base_ = sixdof_frame(shift->value);
    base_value_ = shift->value;
  }
  point_ = base_.rotation * pose.origin + base_.origin;
}

Vector3d ObservationModel::normal(Eigen::Index row) const {
  const auto& n = m_.states.normal;
  return {n[0][row], n[1][row], n[2][row]};
}

const Vector3d& ObservationModel::rotation_vector(std::size_t row) {
  if (has_phi_) return phi_;
  Vector3d measured = Vector3d::Zero();
  // Observations are ordered by row, so those of this row are adjacent.
  auto o = std::lower_bound(m_.observations.begin(), m_.observations.end(), row,
                            [](const Observation& a, std::size_t r) { return a.row < r; });
  for (; o != m_.observations.end() && o->row == row; ++o)
    if (o->kind >= ObservationKind::kRx && o->kind <= ObservationKind::kRz)
      measured[component(o->kind)] = o->value / maths::kDegPerRad;
  phi_ = nearest_rotation_vector(base_.rotation * pose_.rotation, measured);
  has_phi_ = true;
  return phi_;
}

Matrix3d ObservationModel::sight(Eigen::Index row) const {
  Vector3d along = tool_axis();
  if (m_.direction.cols() > 0 && m_.direction.col(row).allFinite()) along = m_.direction.col(row);
  // The first direction across is horizontal, so that the two are those of a mount's axes. Within half a
  // degree of z noise and errors would choose it: there it follows x.
  constexpr double kNearZ = 0.01;  // sine: far above noise and errors of a direction
  const bool near_z = along.head<2>().norm() < kNearZ * std::abs(along.z());
  const Vector3d about = near_z ? Vector3d::UnitX() : Vector3d::UnitZ();
  const Vector3d across = about.cross(along).normalized();
  Matrix3d frame;
  frame << along, across, along.cross(across);
  return frame;
}

double ObservationModel::predicted(const Observation& o) {
  const auto at = static_cast<Eigen::Index>(o.row);
  switch (o.kind) {
    case ObservationKind::kX:
      return point_.x();
    case ObservationKind::kY:
      return point_.y();
    case ObservationKind::kZ:
      return point_.z();
    case ObservationKind::kLength:
      return (point_ - m_.centre.col(at)).norm();
    case ObservationKind::kD:
      return normal(at).dot(pose_.origin - m_.nominal_point.col(at));
    case ObservationKind::kA1:
    case ObservationKind::kA2: {
      const Matrix3d frame = sight(at);
      const Vector3d axis = tool_axis();
      return maths::kDegPerRad * angle_over_sine(frame.col(0).dot(axis)).value *
             frame.col(across(o.kind)).dot(axis);
    }
    case ObservationKind::kDistance:
      return (point_ - other_end_).norm();
    case ObservationKind::kIx:
    case ObservationKind::kIy:
      return maths::kDegPerRad * std::asin(std::clamp(up_.dot(pose_.rotation.col(level(o.kind))), -1.0, 1.0));
    default:
      return maths::kDegPerRad * rotation_vector(o.row)[component(o.kind)];
  }
}

Twist ObservationModel::gradient(const Observation& o) const {
  const auto at = static_cast<Eigen::Index>(o.row);
  Twist g;
  if (o.kind == ObservationKind::kLength) {
    const Vector3d arm = point_ - m_.centre.col(at);
    const double length = arm.norm();
    if (length > 0) g.point = arm / length;
  } else if (o.kind == ObservationKind::kD) {
    g.point = base_.rotation * normal(at);
  } else if (is_direction(o.kind)) {
    // d/d(turn w) of phi(a . d) (e . d), where the tool axis d moves by w x d.
    const Matrix3d frame = sight(at);
    const Vector3d axis = tool_axis(), along = frame.col(0), aside = frame.col(across(o.kind));
    const ValueAndSlope phi = angle_over_sine(along.dot(axis));
    g.rotation =
        maths::kDegPerRad * (phi.value * axis.cross(aside) + aside.dot(axis) * phi.slope * axis.cross(along));
  } else if (o.kind == ObservationKind::kDistance) {
    const Vector3d arm = point_ - other_end_;
    const double length = arm.norm();
    if (length > 0) g.point = arm / length;
  } else if (is_inclination(o.kind)) {
    const Vector3d arm = pose_.rotation.col(level(o.kind));
    const double cosine = std::sqrt(std::max(1 - std::pow(up_.dot(arm), 2), 1e-12));
    g.rotation = base_.rotation * (maths::kDegPerRad / cosine * arm.cross(up_));
  } else if (is_rotation(o.kind)) {
    g.rotation = maths::kDegPerRad * inverse_left_jacobian(phi_).row(component(o.kind)).transpose();
  } else {
    g.point = Vector3d::Unit(static_cast<int>(o.kind));
  }
  return g;
}

}  // namespace vernier::model
