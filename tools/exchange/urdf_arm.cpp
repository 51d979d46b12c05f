// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/urdf_arm.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"
#include "tools/text/error.h"

namespace vernier::exchange {
namespace {

using Eigen::Index;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Joint positions of one pose, mm or deg, an entry for each axis of the machine.
using Joints = std::vector<double>;

struct Joint {
  std::size_t axis = 0;
  Vector3d direction, point;  // in the base, at the reference pose; mm
};

Isometry3d motion_of(const Joint& joint, bool rotary, double by) {
  Isometry3d motion = Isometry3d::Identity();
  if (!rotary) {
    motion.translation() = by * joint.direction;
    return motion;
  }
  motion.linear() = Eigen::AngleAxisd(by / maths::kDegPerRad, joint.direction).toRotationMatrix();
  motion.translation() = joint.point - motion.linear() * joint.point;
  return motion;
}

class Arm {
 public:
  Arm(const model::Machine& machine, const model::States& at) : machine_(machine), at_(at) {
    for (const model::Axis& axis : machine.axes) {
      const bool has_zero = (!axis.min || *axis.min <= 0) && (!axis.max || *axis.max >= 0);
      reference_.push_back(has_zero ? 0 : (axis.min.value_or(*axis.max) + axis.max.value_or(*axis.min)) / 2);
    }
    for (const std::size_t axis : order()) joints_.push_back(joint_of(axis));
    place_points();
    at_reference_ = poses({reference_}).front();
  }

  UrdfFile file() const {
    UrdfFile file;
    file.undetermined = undetermined();
    file.text = text(file.undetermined);
    measure(file);
    return file;
  }

 private:
  static constexpr unsigned long kSeed = 1;
  static constexpr std::size_t kPoses = 1000;

  model::States states(const std::vector<Joints>& joints) const {
    model::States all = model::select_states(at_, std::vector<std::size_t>(joints.size(), 0));
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis)
      for (std::size_t i = 0; i < joints.size(); ++i) all.axis[axis][static_cast<Index>(i)] = joints[i][axis];
    return all;
  }

  std::vector<Isometry3d> poses(const std::vector<Joints>& joints) const {
    const model::Poses found = model::forward(machine_, states(joints));
    std::vector<Isometry3d> list(joints.size(), Isometry3d::Identity());
    for (std::size_t i = 0; i < joints.size(); ++i) {
      list[i].linear() = found.rotation[i];
      list[i].translation() = found.position.col(static_cast<Index>(i));
    }
    return list;
  }

  /// True if the nominal transform changes with the axis.
  bool moves(const model::Machine& nominal, const model::Transform& transform, std::size_t axis) const {
    Joints moved = reference_;
    moved[axis] += 1;
    const model::States both = states({reference_, moved});
    for (std::size_t dof = 0; dof < transform.dof_count(); ++dof) {
      const model::Column value = model::evaluate(nominal, *transform.dof[dof], both);
      if (std::abs(value[1] - value[0]) > 0.5) return true;  // an error is far smaller than its axis
    }
    return false;
  }

  /// Axes from the base to the tool.
  std::vector<std::size_t> order() const {
    const model::Machine nominal = model::nominal_machine(machine_);
    std::vector<std::size_t> order;
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis)
      for (const model::Transform& transform : nominal.workpiece)
        if (moves(nominal, transform, axis))
          throw text::InputError({machine_.file, transform.line}, machine_.axes[axis].name,
                                 "this axis moves the workpiece: URDF export is for an arm");
    for (const model::Transform& transform : nominal.tool)
      for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis)
        if (moves(nominal, transform, axis)) order.push_back(axis);
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis)
      if (std::count(order.begin(), order.end(), axis) != 1)
        throw text::InputError({machine_.file, machine_.axes[axis].line}, machine_.axes[axis].name,
                               "the axis does not move exactly one transform of the chain");
    return order;
  }

  std::vector<UndeterminedJoint> undetermined() const {
    const model::Machine nominal = model::nominal_machine(machine_);
    std::vector<std::size_t> axis_of;
    for (const model::Transform& transform : nominal.tool) {
      axis_of.push_back(kNoAxis);
      for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis)
        if (moves(nominal, transform, axis)) axis_of.back() = axis;
    }
    return undetermined_joints(machine_, axis_of);
  }

  /// Half of the motion by which the axis of a joint is found.
  double half_motion(std::size_t axis) const {
    const model::Axis& one = machine_.axes[axis];
    const double most = one.rotary ? 60 : 100;  // mm, deg
    return std::min(
        {most, one.max ? *one.max - reference_[axis] : most, one.min ? reference_[axis] - *one.min : most});
  }

  Joint joint_of(std::size_t axis) const {
    Joint joint{axis, Vector3d::Zero(), Vector3d::Zero()};
    const double half = std::max(half_motion(axis), 1.0);
    Joints low = reference_, high = reference_;
    low[axis] -= half;
    high[axis] += half;
    const std::vector<Isometry3d> ends = poses({low, high});
    if (!machine_.axes[axis].rotary) {
      joint.direction = (ends[1].translation() - ends[0].translation()).normalized();
      joint.point = ends[0].translation();
      return joint;
    }
    const Isometry3d motion = ends[1] * ends[0].inverse();
    const Eigen::AngleAxisd turn(motion.rotation());
    joint.direction = turn.axis();
    // A point that the motion leaves in place, beside the shift along the axis.
    const Vector3d across =
        motion.translation() - joint.direction.dot(motion.translation()) * joint.direction;
    const Eigen::Matrix3d less = Eigen::Matrix3d::Identity() - motion.rotation();
    joint.point = maths::least_norm(Eigen::MatrixXd(less), Eigen::VectorXd(across));
    return joint;
  }

  /// Each joint at the point of its axis that is nearest to the joint before it.
  void place_points() {
    Vector3d before = Vector3d::Zero();
    for (Joint& joint : joints_) {
      const Vector3d from = before - joint.point;
      if (machine_.axes[joint.axis].rotary)
        joint.point += joint.direction.dot(from) * joint.direction;
      else
        joint.point = before;
      before = joint.point;
    }
  }

  /// Poses of the ideal arm: a product of exponentials.
  Isometry3d ideal(const Joints& at) const {
    Isometry3d pose = Isometry3d::Identity();
    for (const Joint& joint : joints_)
      pose =
          pose * motion_of(joint, machine_.axes[joint.axis].rotary, at[joint.axis] - reference_[joint.axis]);
    return pose * at_reference_;
  }

  void measure(UrdfFile& file) const {
    std::mt19937_64 random(kSeed);
    std::vector<Joints> all;
    for (std::size_t i = 0; i < kPoses; ++i) {
      Joints one;
      for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
        const model::Axis& limits = machine_.axes[axis];
        std::uniform_real_distribution<double> position(limits.min.value_or(-180), limits.max.value_or(180));
        one.push_back(position(random));
      }
      all.push_back(one);
    }
    const std::vector<Isometry3d> real = poses(all);
    for (std::size_t i = 0; i < kPoses; ++i) {
      const Isometry3d held = ideal(all[i]);
      file.worst_um = std::max(file.worst_um, 1000 * (held.translation() - real[i].translation()).norm());
      const Vector3d tilt = held.rotation().col(2).cross(real[i].rotation().col(2));
      file.worst_urad = std::max(file.worst_urad, 1e6 * tilt.norm());
    }
    file.positions = kPoses;
  }

  static std::string triple(const Vector3d& v) {
    const auto plain = [](double value) { return std::abs(value) < 5e-16 ? 0.0 : value; };
    return fmt::format("{:.12g} {:.12g} {:.12g}", plain(v[0]), plain(v[1]), plain(v[2]));
  }

  /// `<origin>` of a frame in its parent's. rpy: fixed axes X, Y, Z.
  static std::string origin(const Isometry3d& frame) {
    const Eigen::Matrix3d r = frame.rotation();
    const double pitch = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
    const bool straight_up = std::hypot(r(0, 0), r(1, 0)) < 1e-12;
    const double yaw = straight_up ? 0 : std::atan2(r(1, 0), r(0, 0));
    const double roll =
        straight_up ? std::atan2(r(0, 1) * (pitch > 0 ? 1 : -1), r(1, 1)) : std::atan2(r(2, 1), r(2, 2));
    return fmt::format("    <origin xyz=\"{}\" rpy=\"{}\"/>\n", triple(frame.translation() / 1000),
                       triple({roll, pitch, yaw}));
  }

  std::string limits_of(const model::Axis& axis) const {
    const double unit = axis.rotary ? maths::kDegPerRad : 1000;
    if (!axis.min || !axis.max) return {};
    return fmt::format("    <limit lower=\"{:.12g}\" upper=\"{:.12g}\" effort=\"0\" velocity=\"0\"/>\n",
                       *axis.min / unit, *axis.max / unit);
  }

  std::string text(const std::vector<UndeterminedJoint>& undetermined) const {
    const std::string open =
        undetermined.empty()
            ? ""
            : fmt::format(
                  "<!-- The readings of the fit do not determine these joints completely; their values are "
                  "set "
                  "by convention or prior:\n     {}.\n     Other values of the same joints give the same "
                  "positions of the tool in the survey. -->\n",
                  joints_text(undetermined));
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<!-- The calibrated joints of {}: m, rad. Each frame is parallel to the base at the reference "
        "pose.\n"
        "     A machine file has no effort and velocity limits: both are 0; write the values of your robot. "
        "-->\n"
        "{}"
        "<robot name=\"{}\">\n"
        "  <link name=\"base_link\"/>\n",
        machine_.name, open, machine_.name);
    std::string parent = "base_link";
    Vector3d at = Vector3d::Zero();
    for (const Joint& joint : joints_) {
      const model::Axis& axis = machine_.axes[joint.axis];
      const std::string child = "link_" + axis.name;
      const bool endless = axis.rotary && (!axis.min || !axis.max);
      // The variable is 0 at its own zero, the frame parallel to the base at the reference pose.
      Isometry3d frame = Isometry3d::Identity();
      frame.translation() = joint.point - at;
      if (axis.rotary)
        frame.linear() = Eigen::AngleAxisd(-reference_[joint.axis] / maths::kDegPerRad, joint.direction)
                             .toRotationMatrix();
      else
        frame.translation() -= reference_[joint.axis] * joint.direction;
      text += fmt::format(
          "  <link name=\"{}\"/>\n  <joint name=\"{}\" type=\"{}\">\n{}    <parent link=\"{}\"/>\n    <child "
          "link=\"{}\"/>\n    <axis xyz=\"{}\"/>\n{}  </joint>\n",
          child, axis.name,
          !axis.rotary ? "prismatic"
          : endless    ? "continuous"
                       : "revolute",
          origin(frame), parent, child, triple(joint.direction), limits_of(axis));
      parent = child;
      at = joint.point;
    }
    Isometry3d tool = at_reference_;
    tool.translation() -= at;
    return text + fmt::format(
                      "  <link name=\"tool\"/>\n  <joint name=\"tool_joint\" type=\"fixed\">\n{}    <parent "
                      "link=\"{}\"/>\n    <child link=\"tool\"/>\n  </joint>\n</robot>\n",
                      origin(tool), parent);
  }

  const model::Machine& machine_;
  const model::States& at_;
  Joints reference_;
  std::vector<Joint> joints_;
  Isometry3d at_reference_;
};

}  // namespace

UrdfFile urdf_arm(const model::Machine& machine, const model::States& at) { return Arm(machine, at).file(); }

}  // namespace vernier::exchange
