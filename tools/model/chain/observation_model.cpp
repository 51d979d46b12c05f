// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/observation_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/maths/alignment.h"
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

int component(ObservationKind kind) { return static_cast<int>(format::component_of(kind)); }

}  // namespace

ObservationModel::ObservationModel(const Measurement& measurement, const std::array<double, 3>& gravity,
                                   const SetUpOfRow& set_up, const Frame& pose)
    : m_(measurement), pose_(pose), up_(-gravity[0], -gravity[1], -gravity[2]) {
  if (set_up.base != nullptr) {
    base_ = sixdof_frame(set_up.base->value);
    base_value_ = set_up.base->value;
  }
  point_ = base_.rotation * pose.origin + base_.origin;
  seen_ = {base_.rotation * pose.rotation, point_};
  if (set_up.tool == nullptr) return;
  has_tool_shift_ = true;
  tool_value_ = set_up.tool->value;
  const Frame mounted = sixdof_frame(tool_value_);
  seen_.origin += seen_.rotation * mounted.origin;
  seen_.rotation *= mounted.rotation;
}

std::array<Twist, 6> ObservationModel::tool_twists() const {
  const Frame mounted = sixdof_frame(tool_value_);
  const Matrix3d turn = base_.rotation * pose_.rotation;
  const Vector3d arm = seen_.origin - point_;
  std::array<Twist, 6> twists = sixdof_twists(tool_value_, mounted.origin);
  // A motion of what is measured is the motion of the tool that has the same effect on it.
  for (Twist& twist : twists) {
    twist.rotation = turn * twist.rotation;
    twist.point = turn * twist.point - twist.rotation.cross(arm);
  }
  return twists;
}

Vector3d ObservationModel::normal(Eigen::Index row) const {
  const auto& n = m_.states.normal;
  return {n[0][row], n[1][row], n[2][row]};
}

const Vector3d& ObservationModel::rotation_vector(std::size_t row) {
  if (has_phi_) return phi_;
  phi_ = nearest_rotation_vector(seen_.rotation, measured_rotation(row, ObservationKind::kRx));
  has_phi_ = true;
  return phi_;
}

const Vector3d& ObservationModel::board_error(std::size_t row) {
  if (has_board_error_) return board_error_;
  const Matrix3d measured = maths::rotation_of(measured_rotation(row, ObservationKind::kBoardRx));
  board_error_ = nearest_rotation_vector(measured * seen_.rotation, Vector3d::Zero());
  has_board_error_ = true;
  return board_error_;
}

Vector3d ObservationModel::measured_rotation(std::size_t row, ObservationKind first) const {
  Vector3d measured = Vector3d::Zero();
  // Observations are ordered by row, so those of this row are adjacent.
  auto o = std::lower_bound(m_.observations.begin(), m_.observations.end(), row,
                            [](const Observation& a, std::size_t r) { return a.row < r; });
  for (; o != m_.observations.end() && o->row == row; ++o)
    if (format::form_of(o->kind) == format::form_of(first))
      measured[component(o->kind)] = o->value / maths::kDegPerRad;
  return measured;
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
    case ObservationKind::kY:
    case ObservationKind::kZ:
      return seen_.origin[component(o.kind)];
    case ObservationKind::kLength:
      return (seen_.origin - m_.centre.col(at)).norm();
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
      return (seen_.origin - other_end_).norm();
    case ObservationKind::kBoardX:
    case ObservationKind::kBoardY:
    case ObservationKind::kBoardZ:
      return -seen_.rotation.col(component(o.kind)).dot(seen_.origin);
    case ObservationKind::kBoardRx:
    case ObservationKind::kBoardRy:
    case ObservationKind::kBoardRz:
      return o.value - maths::kDegPerRad * board_error(o.row)[component(o.kind)];
    case ObservationKind::kIx:
    case ObservationKind::kIy:
      return maths::kDegPerRad * std::asin(std::clamp(up_.dot(pose_.rotation.col(level(o.kind))), -1.0, 1.0));
    default:
      return maths::kDegPerRad * rotation_vector(o.row)[component(o.kind)];
  }
}

Twist ObservationModel::gradient(const Observation& o) const {
  Twist g;
  if (o.kind == ObservationKind::kD) {
    g.point = base_.rotation * normal(static_cast<Eigen::Index>(o.row));
  } else if (is_inclination(o.kind)) {
    const Vector3d arm = pose_.rotation.col(level(o.kind));
    const double cosine = std::sqrt(std::max(1 - std::pow(up_.dot(arm), 2), 1e-12));
    g.rotation = base_.rotation * (maths::kDegPerRad / cosine * arm.cross(up_));
  } else {
    g = gradient_of_seen(o);
    // A rotation of the tool also moves what is mounted beside the tool point.
    if (has_tool_shift_) g.rotation += (seen_.origin - point_).cross(g.point);
  }
  return g;
}

Twist ObservationModel::gradient_of_seen(const Observation& o) const {
  const auto at = static_cast<Eigen::Index>(o.row);
  Twist g;
  if (o.kind == ObservationKind::kLength) {
    const Vector3d arm = seen_.origin - m_.centre.col(at);
    const double length = arm.norm();
    if (length > 0) g.point = arm / length;
  } else if (is_direction(o.kind)) {
    // d/d(turn w) of phi(a . d) (e . d), where the tool axis d moves by w x d.
    const Matrix3d frame = sight(at);
    const Vector3d axis = tool_axis(), along = frame.col(0), aside = frame.col(across(o.kind));
    const ValueAndSlope phi = angle_over_sine(along.dot(axis));
    g.rotation =
        maths::kDegPerRad * (phi.value * axis.cross(aside) + aside.dot(axis) * phi.slope * axis.cross(along));
  } else if (o.kind == ObservationKind::kDistance) {
    const Vector3d arm = seen_.origin - other_end_;
    const double length = arm.norm();
    if (length > 0) g.point = arm / length;
  } else if (format::form_of(o.kind) == format::ReadingForm::kBoard) {
    // The camera at p with the axes g_k sees the origin of the measuring frame at -g_k . p.
    const Vector3d along = seen_.rotation.col(component(o.kind));
    g.point = -along;
    g.rotation = seen_.origin.cross(along);
  } else if (format::form_of(o.kind) == format::ReadingForm::kBoardRotation) {
    // A turn w of the camera turns the board by -G^T w: the error e changes by J^-1(-e) G^T w.
    g.rotation =
        -maths::kDegPerRad * (seen_.rotation * inverse_left_jacobian(board_error_).col(component(o.kind)));
  } else if (is_rotation(o.kind)) {
    g.rotation = maths::kDegPerRad * inverse_left_jacobian(phi_).row(component(o.kind)).transpose();
  } else {
    g.point = Vector3d::Unit(static_cast<int>(o.kind));
  }
  return g;
}

}  // namespace vernier::model
