// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/create/urdf.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>

#include "tools/format/urdf_chain.h"
#include "tools/model/expression.h"
#include "tools/model/measurement_names.h"
#include "tools/text/error.h"

namespace vernier::create {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using format::JointLine;
using format::UrdfJoint;

constexpr double kDegPerRad = 180 / 3.14159265358979323846, kMmPerM = 1000;

/// The component of `v` perpendicular to the unit vector `along`.
Vector3d across(const Vector3d& v, const Vector3d& along) { return v - v.dot(along) * along; }

double angle_deg(const Vector3d& from, const Vector3d& to, const Vector3d& about) {
  return kDegPerRad * std::atan2(from.cross(to).dot(about), from.dot(to));
}

/// Clears what rounding left of a zero, in mm or deg.
double clean(double value) { return std::abs(value) < 1e-10 ? 0 : value; }

Isometry3d moved(const DhRow& row) {
  const auto turn = [](double deg, const Vector3d& axis) {
    return Eigen::AngleAxisd(deg / kDegPerRad, axis);
  };
  return Isometry3d(Eigen::Translation3d(0, 0, row.d) * turn(row.theta, Vector3d::UnitZ()) *
                    Eigen::Translation3d(row.a, 0, 0) * turn(row.alpha, Vector3d::UnitX()) *
                    turn(row.beta, Vector3d::UnitY()));
}

/// Hayati's row: to where the next axis meets this frame's own plane.
DhRow row_to_parallel(const JointLine& next) {
  DhRow row;
  const Vector3d at = next.point - next.point.z() / next.direction.z() * next.direction;
  row.a = clean(at.norm());
  double theta = row.a > 0 ? std::atan2(at.y(), at.x()) : 0;
  if (std::abs(theta) > std::acos(0.0) + 1e-12) {  // the other way round is the smaller turn
    theta -= std::copysign(std::acos(-1.0), theta);
    row.a = -row.a;
  }
  row.theta = clean(theta * kDegPerRad);
  const Vector3d z = Eigen::AngleAxisd(-row.theta / kDegPerRad, Vector3d::UnitZ()) * next.direction;
  row.beta = clean(std::asin(std::clamp(z.x(), -1.0, 1.0)) * kDegPerRad);
  row.alpha = clean(std::atan2(-z.y(), z.z()) * kDegPerRad);
  return row;
}

/// Along the common normal.
DhRow row_along_normal(const JointLine& next) {
  const Vector3d z = Vector3d::UnitZ();
  Vector3d x = z.cross(next.direction).normalized();
  if (x.x() < -1e-12) x = -x;  // the smaller turn
  DhRow row;
  row.theta = clean(angle_deg(Vector3d::UnitX(), x, z));
  row.alpha = clean(angle_deg(z, next.direction, x));
  // The point of the line nearest to z: its component across x is zero in the plane of z and x.
  row.a = clean(next.point.dot(x));
  const Vector3d y = z.cross(x);
  const double along = -next.point.dot(y) / next.direction.dot(y);
  row.d = clean(next.point.z() + along * next.direction.z());
  return row;
}

DhRow row_to(const Isometry3d& frame, const JointLine& next) {
  constexpr double kNearlyParallel = 0.05;  // rad
  const JointLine seen{frame.inverse() * next.point, frame.linear().transpose() * next.direction};
  const double sine = Vector3d::UnitZ().cross(seen.direction).norm();
  return sine < kNearlyParallel ? row_to_parallel(seen) : row_along_normal(seen);
}

/// The last row: up to the height of the tip, rotated until x is the x of the tip if possible.
DhRow row_to_tip(const Isometry3d& tip) {
  DhRow row;
  row.d = clean(tip.translation().z());
  const Vector3d side = across(tip.linear().col(0), Vector3d::UnitZ());
  if (side.norm() > 1e-6) row.theta = clean(angle_deg(Vector3d::UnitX(), side, Vector3d::UnitZ()));
  return row;
}

bool is_static_of_arm(const std::string& name) {
  const std::size_t letters = std::min(name.find_first_of("0123456789"), name.size());
  const std::string kind = name.substr(0, letters);
  const bool numbered =
      letters < name.size() && name.find_first_not_of("0123456789", letters) == std::string::npos;
  return numbered ? kind == "th" || kind == "d" || kind == "a" || kind == "al" || kind == "be"
                  : kind == "TPX" || kind == "TPY" || kind == "TPZ";
}

/// The joint's name as a valid name of an axis in a machine file: letters, digits, and no name of the arm's
/// statics (a1, th2).
std::string axis_name(const std::string& joint) {
  std::string name = joint;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  const bool is_name = !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0;
  const bool taken = model::is_reserved_word(name) || model::is_no_axis_name({}, name);
  return !is_name || taken || is_static_of_arm(name) ? "J" + name : name;
}

PlannedAxis axis_of(const UrdfJoint& joint, const std::string& file) {
  const double unit = joint.slides() ? kMmPerM : kDegPerRad;
  PlannedAxis axis{axis_name(joint.name),      -180, 180, joint.slides() ? 'Z' : 'C',
                   joint.type == "continuous", {}};
  if (axis.name != joint.name) axis.joint = joint.name;
  if (axis.rollover) return axis;
  if (!joint.lower || !joint.upper || !(*joint.lower < *joint.upper))
    throw text::InputError({file, joint.line}, joint.name,
                           "a joint of this type needs a lower and an upper limit");
  axis.min = clean(std::round(*joint.lower * unit * 1e6) / 1e6);
  axis.max = clean(std::round(*joint.upper * unit * 1e6) / 1e6);
  return axis;
}

void require_arm(const std::vector<UrdfJoint>& way, const std::string& file) {
  constexpr double kLongest_mm = 20e3;  // no link of an arm is longer
  constexpr double kMostTurn_rad = 20;  // more than three turns to each side
  for (const UrdfJoint& one : way) {
    if (one.origin.translation().norm() > kLongest_mm)
      throw text::InputError(
          {file, one.line}, one.name,
          fmt::format("this joint is {:g} m from the joint before it: the lengths of a URDF "
                      "are in m, and these are probably in mm",
                      one.origin.translation().norm() / kMmPerM));
    if (one.slides() &&
        std::max(std::abs(one.lower.value_or(0)), std::abs(one.upper.value_or(0))) * kMmPerM > kLongest_mm)
      throw text::InputError(
          {file, one.line}, one.name,
          fmt::format("the limits are {:g} and {:g} m: the lengths of a URDF are in m, and "
                      "these are probably in mm",
                      one.lower.value_or(0), one.upper.value_or(0)));
    if (!one.slides() && (one.lower.value_or(0) < -kMostTurn_rad || one.upper.value_or(0) > kMostTurn_rad))
      throw text::InputError(
          {file, one.line}, one.name,
          fmt::format("the limits {:g} to {:g} are more than three turns: the angles of a URDF "
                      "are in rad, and these are probably in deg",
                      one.lower.value_or(0), one.upper.value_or(0)));
    if (one.type != "fixed" && one.type != "revolute" && one.type != "continuous" && one.type != "prismatic")
      throw text::InputError({file, one.line}, one.type,
                             "a joint of an arm is revolute, continuous, prismatic or fixed");
    if (one.mimic)
      throw text::InputError({file, one.line}, one.name,
                             "this joint follows another joint (mimic): an arm cannot have such a joint");
  }
}

std::array<double, 6> six_of(const Isometry3d& frame) {
  const Vector3d at = frame.translation();
  const Vector3d turn = frame.linear().eulerAngles(0, 1, 2) * kDegPerRad;
  return {clean(at.x()), clean(at.y()), clean(at.z()), clean(turn.x()), clean(turn.y()), clean(turn.z())};
}

}  // namespace

std::array<double, 3> UrdfArm::tool(const std::array<double, 3>& in_tip) const {
  const Vector3d at = tip_at + tip_rotation * Vector3d(in_tip[0], in_tip[1], in_tip[2]);
  const auto rounded = [](double mm) { return clean(std::round(mm * 1e9) / 1e9); };
  return {rounded(at.x()), rounded(at.y()), rounded(at.z())};
}

UrdfArm parse_urdf(const std::string& text, const std::string& file, const std::string& tip) {
  const format::UrdfTree tree(text, file);
  UrdfArm arm;
  arm.name = tree.name();
  if (!tip.empty()) tree.require_link(tip);
  arm.tip = tip.empty() ? tree.only_end() : tip;
  const std::vector<UrdfJoint> way = tree.way_to(arm.tip);
  require_arm(way, file);
  arm.root = way.empty() ? arm.tip : way.front().parent;
  Isometry3d at = Isometry3d::Identity();
  std::vector<JointLine> lines;
  for (const UrdfJoint& joint : way) {
    at = at * joint.origin;
    if (!joint.moves()) continue;
    arm.axes.push_back(axis_of(joint, file));
    lines.push_back({at.translation(), at.linear() * joint.axis});
    arm.rows.emplace_back().prismatic = joint.slides();
  }
  if (lines.empty())
    throw text::InputError({file, 1}, arm.tip, "no joint between the root and this link moves");
  Isometry3d frame = format::first_row_frame(lines.front());
  arm.base = six_of(frame);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool prismatic = arm.rows[i].prismatic;
    arm.rows[i] = i + 1 < lines.size() ? row_to(frame, lines[i + 1]) : row_to_tip(frame.inverse() * at);
    arm.rows[i].prismatic = prismatic;
    frame = frame * moved(arm.rows[i]);
  }
  const Isometry3d rest = frame.inverse() * at;
  arm.tip_rotation = rest.linear();
  arm.tip_at = rest.translation().unaryExpr(&clean);
  arm.tip_frame = six_of(rest);
  return arm;
}

}  // namespace vernier::create
