#include "tools/model/chain_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

namespace vernier {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
constexpr double kRad = std::numbers::pi / 180;

Matrix3d turn(double angle_deg, const Vector3d& axis) {
  if (angle_deg == 0) return Matrix3d::Identity();
  return Eigen::AngleAxisd(angle_deg * kRad, axis).toRotationMatrix();
}

Frame dh_frame(double theta_deg, double d, double a, double alpha_deg) {
  Frame frame;
  const Matrix3d rz = turn(theta_deg, Vector3d::UnitZ());
  frame.rotation = rz * turn(alpha_deg, Vector3d::UnitX());
  frame.origin = d * Vector3d::UnitZ() + a * rz.col(0);
  return frame;
}

Frame compose(const Frame& below, const Frame& above) {
  return {below.rotation * above.rotation, below.rotation * above.origin + below.origin};
}

Twist shift_along(const Vector3d& direction) { return {direction, Vector3d::Zero()}; }
Twist turn_about(const Vector3d& axis, const Vector3d& through, const Vector3d& point) {
  return {kRad * axis.cross(point - through), kRad * axis};
}

}  // namespace

Frame sixdof_frame(const std::array<double, 6>& v) {
  return {turn(v[3], Vector3d::UnitX()) * turn(v[4], Vector3d::UnitY()) * turn(v[5], Vector3d::UnitZ()),
          Vector3d(v[0], v[1], v[2])};
}

std::array<Twist, 6> sixdof_twists(const std::array<double, 6>& v, const Vector3d& point) {
  const Vector3d origin(v[0], v[1], v[2]);
  const Matrix3d rx = turn(v[3], Vector3d::UnitX());
  const Matrix3d rxy = rx * turn(v[4], Vector3d::UnitY());
  return {shift_along(Vector3d::UnitX()),       shift_along(Vector3d::UnitY()),
          shift_along(Vector3d::UnitZ()),       turn_about(Vector3d::UnitX(), origin, point),
          turn_about(rx.col(1), origin, point), turn_about(rxy.col(2), origin, point)};
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
    Dual dual = evaluate(*transform.dof[i]);
    if (!dual.value.all_finite()) {
      std::size_t row = 0;
      while (row + 1 < count_ && std::isfinite(dual.value[row])) ++row;
      throw InputError({machine_.file, transform.line}, transform.text[i],
                       std::string("not a finite number, in ") + transform.dof_name(i) + " of transform " +
                           std::to_string(transform.n) + " (" + branch + "), data row " +
                           std::to_string(row + 1));
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
  Frame tool, work;
  for (const Link& link : tool_) tool = compose(tool, frame_of(link, i));
  for (const Link& link : workpiece_) work = compose(work, frame_of(link, i));
  const Matrix3d to_workpiece = work.rotation.transpose();
  twists.assign(keys_.size(), Twist{});
  // Both branches move the tool point in the common base; what carries the workpiece moves it the other way.
  for (const auto& [links, sense] : {std::pair{&tool_, 1.0}, std::pair{&workpiece_, -1.0}}) {
    Frame below;
    for (const Link& link : *links) {
      add_twists(link, i, below, tool.origin, to_workpiece, sense, twists);
      below = compose(below, frame_of(link, i));
    }
  }
  return {to_workpiece * tool.rotation, to_workpiece * (tool.origin - work.origin)};
}

void ChainRows::add_twists(const Link& link, std::size_t i, const Frame& below, const Vector3d& tip,
                           const Matrix3d& to_workpiece, double sense, std::vector<Twist>& twists) {
  bool any = false;
  for (const Dof& dof : link.dof) any = any || !dof.by.empty();
  if (!any) return;
  const auto v = [&](std::size_t k) { return link.dof[k].value[i]; };
  const Vector3d point = below.rotation.transpose() * (tip - below.origin);  // tip seen from below the link
  std::array<Twist, 6> by_dof;
  if (link.kind == TransformKind::kSixDof) {
    by_dof = sixdof_twists({v(0), v(1), v(2), v(3), v(4), v(5)}, point);
  } else {
    const Vector3d x = turn(v(0), Vector3d::UnitZ()).col(0);
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

}  // namespace vernier
