// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/chain_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tools/maths/factors.h"

namespace vernier::model {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Sine and cosine of an angle in degrees. Most angles of most machines are exactly zero.
struct TurnValues {
  explicit TurnValues(double angle_deg) {
    if (angle_deg == 0) return;
    s = std::sin(angle_deg * maths::kRadPerDeg);
    c = std::cos(angle_deg * maths::kRadPerDeg);
  }
  double s = 0, c = 1;
};

/// Rz(theta)*T(0,0,d)*T(a,0,0)*Rx(alpha).
Frame dh_frame(double theta_deg, double d, double a, double alpha_deg) {
  const TurnValues z(theta_deg), x(alpha_deg);
  Frame frame;
  frame.rotation << z.c, -z.s * x.c, z.s * x.s,  //
      z.s, z.c * x.c, -z.c * x.s,                //
      0, x.s, x.c;
  frame.origin = Vector3d(a * z.c, a * z.s, d);
  return frame;
}

Frame compose(const Frame& below, const Frame& above) {
  return {below.rotation * above.rotation, below.rotation * above.origin + below.origin};
}

Twist shift_along(const Vector3d& direction) { return {direction, Vector3d::Zero()}; }
Twist turn_about(const Vector3d& axis, const Vector3d& through, const Vector3d& point) {
  return {maths::kRadPerDeg * axis.cross(point - through), maths::kRadPerDeg * axis};
}

}  // namespace

Frame sixdof_frame(const std::array<double, 6>& v) {
  const TurnValues x(v[3]), y(v[4]), z(v[5]);
  Frame frame;
  frame.rotation << y.c * z.c, -y.c * z.s, y.s,  //
      x.c * z.s + x.s * y.s * z.c, x.c * z.c - x.s * y.s * z.s, -x.s * y.c, x.s * z.s - x.c * y.s * z.c,
      x.s * z.c + x.c * y.s * z.s, x.c * y.c;
  frame.origin = Vector3d(v[0], v[1], v[2]);
  return frame;
}

std::array<Twist, 6> sixdof_twists(const std::array<double, 6>& v, const Vector3d& point) {
  const TurnValues x(v[3]), y(v[4]);
  const Vector3d origin(v[0], v[1], v[2]);
  return {shift_along(Vector3d::UnitX()),
          shift_along(Vector3d::UnitY()),
          shift_along(Vector3d::UnitZ()),
          turn_about(Vector3d::UnitX(), origin, point),
          turn_about(Vector3d(0, x.c, x.s), origin, point),
          turn_about(Vector3d(y.s, -x.s * y.c, x.c * y.c), origin, point)};
}

ChainRows::ChainRows(const Machine& machine, const States& states, std::vector<char> active)
    : machine_(machine), count_(states.count) {
  Evaluator evaluate(machine, states, std::move(active));
  for (const Transform& transform : machine.workpiece)
    workpiece_.push_back(link(transform, "workpiece", evaluate));
  for (const Transform& transform : machine.tool) tool_.push_back(link(transform, "tool", evaluate));
}

ChainRows::Link ChainRows::link(const Transform& transform, const char* branch, Evaluator& evaluate) {
  Link result{transform.kind, {}};
  for (std::size_t i = 0; i < transform.dof_count(); ++i) {
    ValueAndSlopes dual = evaluate(*transform.dof[i]);
    if (!dual.value.all_finite()) {
      std::size_t row = 0;
      while (row + 1 < count_ && std::isfinite(dual.value[row])) ++row;
      throw text::InputError({machine_.file, transform.line}, transform.text[i],
                             std::string("not a finite number, in ") + transform.dof_name(i) +
                                 " of transform " + std::to_string(transform.n) + " (" + branch +
                                 "), data row " + std::to_string(row + 1));
    }
    Dof& dof = result.dof[i];
    dof.value = std::move(dual.value);
    for (auto& [key, derivative] : dual.by) {
      auto found = std::find(keys_.begin(), keys_.end(), key);
      if (found == keys_.end()) found = keys_.insert(keys_.end(), key);
      dof.by.emplace_back(static_cast<std::size_t>(found - keys_.begin()), std::move(derivative));
    }
  }
  return result;
}

Frame ChainRows::frame_of(const Link& link, std::size_t i) {
  const auto v = [&](std::size_t k) { return link.dof[k].value[i]; };
  if (link.kind == TransformKind::kDh) return dh_frame(v(0), v(1), v(2), v(3));
  return sixdof_frame({v(0), v(1), v(2), v(3), v(4), v(5)});
}

Frame ChainRows::pose(std::size_t i) const {
  Frame tool, work;
  for (const Link& link : tool_) tool = compose(tool, frame_of(link, i));
  for (const Link& link : workpiece_) work = compose(work, frame_of(link, i));
  return {work.rotation.transpose() * tool.rotation, work.rotation.transpose() * (tool.origin - work.origin)};
}

Frame ChainRows::pose(std::size_t i, std::vector<Twist>& twists) const {
  // The frame below each link, tool branch then workpiece branch; the last of each branch is its end.
  thread_local std::vector<Frame> below;
  below.clear();
  for (const std::vector<Link>* links : {&tool_, &workpiece_}) {
    below.emplace_back();
    for (const Link& link : *links) below.push_back(compose(below.back(), frame_of(link, i)));
  }
  const Frame& tool = below[tool_.size()];
  const Frame& work = below.back();
  const Matrix3d to_workpiece = work.rotation.transpose();
  twists.assign(keys_.size(), Twist{});
  // Both branches move the tool point in the common base. The workpiece branch moves it in the
  // opposite direction.
  for (std::size_t k = 0; k < tool_.size(); ++k)
    add_twists(tool_[k], i, below[k], tool.origin, to_workpiece, 1, twists);
  for (std::size_t k = 0; k < workpiece_.size(); ++k)
    add_twists(workpiece_[k], i, below[tool_.size() + 1 + k], tool.origin, to_workpiece, -1, twists);
  return {to_workpiece * tool.rotation, to_workpiece * (tool.origin - work.origin)};
}

void ChainRows::add_twists(const Link& link, std::size_t i, const Frame& below, const Vector3d& tip,
                           const Matrix3d& to_workpiece, double sense, std::vector<Twist>& twists) {
  bool any = false;
  for (const Dof& dof : link.dof) any = any || !dof.by.empty();
  if (!any) return;
  const auto v = [&](std::size_t k) { return link.dof[k].value[i]; };
  const Vector3d point =
      below.rotation.transpose() * (tip - below.origin);  // tip in the frame below the link
  std::array<Twist, 6> by_dof;
  if (link.kind == TransformKind::kSixDof) {
    by_dof = sixdof_twists({v(0), v(1), v(2), v(3), v(4), v(5)}, point);
  } else {
    const TurnValues z(v(0));
    const Vector3d x(z.c, z.s, 0);
    by_dof[0] = turn_about(Vector3d::UnitZ(), Vector3d::Zero(), point);
    by_dof[1] = shift_along(Vector3d::UnitZ());
    by_dof[2] = shift_along(x);
    by_dof[3] = turn_about(x, v(1) * Vector3d::UnitZ() + v(2) * x, point);
  }
  const Matrix3d turned = sense * to_workpiece * below.rotation;
  for (std::size_t k = 0; k < link.dof.size(); ++k)
    for (const auto& [slot, derivative] : link.dof[k].by) {
      twists[slot].point += derivative[i] * (turned * by_dof[k].point);
      twists[slot].rotation += derivative[i] * (turned * by_dof[k].rotation);
    }
}

}  // namespace vernier::model
