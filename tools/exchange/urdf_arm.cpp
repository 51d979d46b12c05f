// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/urdf_arm.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <pugixml.hpp>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"
#include "tools/model/fit_record.h"
#include "tools/text/error.h"
#include "tools/text/words.h"
#include "tools/text/xml_text.h"

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
  Arm(const model::Machine& machine, const model::States& at, const std::vector<std::string>& names)
      : machine_(machine), at_(at), names_(names) {
    if (names_.empty())
      for (const model::Axis& axis : machine.axes) names_.push_back(axis.name);
    for (const model::Axis& axis : machine.axes) {
      const bool has_zero = (!axis.min || *axis.min <= 0) && (!axis.max || *axis.max >= 0);
      reference_.push_back(has_zero ? 0 : (axis.min.value_or(*axis.max) + axis.max.value_or(*axis.min)) / 2);
    }
    for (const std::size_t axis : order()) joints_.push_back(joint_of(axis));
    place_points();
    at_reference_ = poses({reference_}).front();
    fit_joints();
    place_points();
  }

  /// The arm with all joint variables at 0: the axes that the joints before them carry from the reference
  /// pose.
  IdealArm at_zero() const {
    IdealArm arm;
    Isometry3d back = Isometry3d::Identity();
    for (const Joint& joint : joints_) {
      arm.joints.push_back(names_[joint.axis]);
      arm.axes.push_back({back * joint.point, back.linear() * joint.direction});
      back = back * motion_of(joint, machine_.axes[joint.axis].rotary, -reference_[joint.axis]);
    }
    const Vector3d tool = tool_point();
    std::copy(tool.begin(), tool.end(), arm.tool_mm.begin());
    arm.last = back * at_reference_ * Eigen::Translation3d(-tool);
    return arm;
  }

  UrdfFile file(const UrdfOriginal* original) const {
    UrdfFile file;
    file.undetermined = undetermined();
    for (UndeterminedJoint& one : file.undetermined)
      if (const auto axis = machine_.find_axis(one.joint)) one.joint = names_[*axis];
    if (original == nullptr) {
      file.text = text(file.undetermined);
    } else {
      const model::Machine nominal = model::nominal_machine(machine_);
      file.original = calibrated_original(*original, at_zero(), Arm(nominal, at_, names_).at_zero());
      file.text = with_comment(*file.original, file.undetermined);
    }
    measure(file);
    return file;
  }

 private:
  static constexpr unsigned long kSeed = 1, kSeedOfFit = 2;
  static constexpr std::size_t kPoses = 1000;
  static constexpr double kLever_mm =
      100;  // a rotation of the tool counts as the motion of a point so far away

  model::States states(const std::vector<Joints>& joints) const {
    model::States all = model::select_states(at_, std::vector<std::size_t>(joints.size(), 0));
    for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis)
      for (std::size_t i = 0; i < joints.size(); ++i) all.axis[axis][static_cast<Index>(i)] = joints[i][axis];
    return all;
  }

  /// The tool point in the frame of the last row, mm: what the statics of its X, Y, Z add that only move this
  /// point, in every pose alike. These are TPX, TPY, TPZ of `vernier new`, and an offset of the point that a
  /// diagnosis added.
  Vector3d tool_point() const {
    constexpr double kSame_mm = 1e-9;
    Vector3d sum = Vector3d::Zero();
    if (machine_.tool.empty() || machine_.tool.back().kind != model::TransformKind::kSixDof) return sum;
    std::set<std::size_t> named;
    for (std::size_t dof = 0; dof < 3; ++dof)
      model::walk(*machine_.tool.back().dof[dof], [&](const model::Expr& node) {
        if (node.op == model::Op::kSymbol && node.symbol.kind == model::SymbolKind::kStatic)
          named.insert(static_cast<std::size_t>(node.symbol.index));
      });
    constexpr std::size_t kSome = 9;  // poses
    std::vector<Joints> some = random_poses(kSeed);
    some.resize(kSome);
    some.front() = reference_;
    const std::vector<Isometry3d> with = poses(some);
    for (const std::size_t one : named) {
      model::Machine changed = machine_;
      changed.statics[one].value = 0;
      const std::vector<Isometry3d> without = poses_of(changed, some);
      const Vector3d by = (without.front().inverse() * with.front()).translation();
      bool alike = true;
      for (std::size_t i = 0; i < kSome && alike; ++i)
        alike = without[i].linear().isApprox(with[i].linear(), kSame_mm) &&
                ((without[i].inverse() * with[i]).translation() - by).norm() < kSame_mm;
      if (alike) sum += by;
    }
    return sum;
  }

  std::vector<Isometry3d> poses(const std::vector<Joints>& joints) const {
    return poses_of(machine_, joints);
  }

  std::vector<Isometry3d> poses_of(const model::Machine& machine, const std::vector<Joints>& joints) const {
    const model::Poses found = model::forward(machine, states(joints));
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

  /// Range of an axis in which the arm is fitted and tested: the measured range, otherwise that of the axis.
  std::pair<double, double> range_of(std::size_t axis) const {
    const model::Axis& limits = machine_.axes[axis];
    if (machine_.fitted)
      for (const model::FitRecord::Range& range : machine_.fitted->measured)
        if (range.name == limits.name) return {range.min, range.max};
    return {limits.min.value_or(-180), limits.max.value_or(180)};
  }

  std::vector<Joints> random_poses(unsigned long seed) const {
    std::mt19937_64 random(seed);
    std::vector<Joints> all;
    for (std::size_t i = 0; i < kPoses; ++i) {
      Joints one;
      for (std::size_t axis = 0; axis < machine_.axes.size(); ++axis) {
        const auto [low, high] = range_of(axis);
        one.push_back(low < high ? std::uniform_real_distribution<double>(low, high)(random) : low);
      }
      all.push_back(one);
    }
    return all;
  }

  /// Differences of the tool point, and of its rotation at the lever: six values a pose, mm.
  Eigen::VectorXd differences(const std::vector<Joints>& all, const std::vector<Isometry3d>& real) const {
    Eigen::VectorXd list(6 * static_cast<Index>(all.size()));
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Isometry3d held = ideal(all[i]);
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(real[i].linear() * held.linear().transpose()));
      list.segment<3>(6 * static_cast<Index>(i)) = real[i].translation() - held.translation();
      list.segment<3>(6 * static_cast<Index>(i) + 3) = kLever_mm * turn.angle() * turn.axis();
    }
    return list;
  }

  /// Moves a joint by four values, or the tool by six (mm; a rotation at the lever, mm).
  void move(std::size_t joint, Index value, double by) {
    if (joint == joints_.size()) {
      if (value < 3)
        at_reference_.translation()[value] += by;
      else
        at_reference_.linear() =
            Eigen::AngleAxisd(by / kLever_mm, Vector3d::Unit(value - 3)).toRotationMatrix() *
            at_reference_.linear();
      return;
    }
    Joint& one = joints_[joint];
    const Vector3d across = one.direction.unitOrthogonal();
    const Vector3d side = value % 2 == 0 ? across : one.direction.cross(across);
    if (value < 2)
      one.direction = (one.direction + by / kLever_mm * side).normalized();
    else
      one.point += by * side;
  }

  /// Gauss-Newton steps from the joints that were found one by one. An arm of ideal joints is left as found.
  void fit_joints() {
    constexpr int kMostSteps = 10;
    constexpr double kExact_mm = 1e-6, kStep_mm = 1e-3, kSettled = 1e-6;
    const std::vector<Joints> all = random_poses(kSeedOfFit);
    const std::vector<Isometry3d> real = poses(all);
    Eigen::VectorXd rest = differences(all, real);
    const double exact = kExact_mm * std::sqrt(static_cast<double>(rest.size()));
    for (int step = 0; step < kMostSteps && rest.norm() > exact; ++step) {
      std::vector<std::pair<std::size_t, Index>> values;
      for (std::size_t joint = 0; joint <= joints_.size(); ++joint)
        for (Index k = 0; k < (joint == joints_.size() ? 6 : 4); ++k) values.emplace_back(joint, k);
      const std::vector<Joint> joints = joints_;
      const Isometry3d tool = at_reference_;
      Eigen::MatrixXd slope(rest.size(), static_cast<Index>(values.size()));
      for (std::size_t k = 0; k < values.size(); ++k) {
        move(values[k].first, values[k].second, kStep_mm);
        slope.col(static_cast<Index>(k)) = (rest - differences(all, real)) / kStep_mm;
        joints_ = joints, at_reference_ = tool;
      }
      // Least norm: the point of a prismatic joint, or a joint that did not move, changes nothing.
      const Eigen::VectorXd change = maths::least_norm(slope, rest);
      for (std::size_t k = 0; k < values.size(); ++k)
        move(values[k].first, values[k].second, change[static_cast<Index>(k)]);
      const Eigen::VectorXd next = differences(all, real);
      const double gain = 1 - next.norm() / rest.norm();
      if (!(gain > 0)) {
        joints_ = joints, at_reference_ = tool;
        return;
      }
      rest = next;
      if (gain < kSettled) return;
    }
  }

  /// Rms difference of the nominal arm from the machine. The base and the tool point of the nominal arm are
  /// fitted, because a user states both for his set-up: an unknown tool is no error of the arm. Steps of
  /// least squares from the nominal base and tool, linear in the tool point and in the rotation of the base.
  static double rms_aligned_mm(const model::Poses& nominal, const std::vector<Isometry3d>& real) {
    constexpr int kSteps = 5;  // the rotation of the base is small: two are enough
    const auto n = static_cast<Index>(real.size());
    Vector3d tool = Vector3d::Zero();
    Isometry3d base = Isometry3d::Identity();
    Eigen::VectorXd rest(3 * n);
    Eigen::MatrixXd slope(3 * n, 9);
    for (int step = 0; step <= kSteps; ++step) {
      for (Index i = 0; i < n; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const Vector3d point = base * Vector3d(nominal.position.col(i) + nominal.rotation[at] * tool);
        rest.segment<3>(3 * i) = real[at].translation() - point;
        slope.block<3, 3>(3 * i, 0).setIdentity();
        for (Index k = 0; k < 3; ++k)
          slope.block<3, 1>(3 * i, 3 + k) = Vector3d::Unit(k).cross(point) / kLever_mm;
        slope.block<3, 3>(3 * i, 6) = base.linear() * nominal.rotation[at];
      }
      if (step == kSteps) break;
      const Eigen::VectorXd change = maths::least_norm(slope, rest);
      const Vector3d turn = change.segment<3>(3) / kLever_mm;
      Isometry3d moved = Isometry3d::Identity();
      if (turn.norm() > 0)
        moved.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
      moved.translation() = change.head<3>();
      base = moved * base;
      tool += change.tail<3>();
    }
    return std::sqrt(rest.squaredNorm() / static_cast<double>(n));
  }

  void measure(UrdfFile& file) const {
    const std::vector<Joints> all = random_poses(kSeed);
    const std::vector<Isometry3d> real = poses(all);
    const model::Poses nominal = model::forward(model::nominal_machine(machine_), states(all));
    double sum = 0;
    for (std::size_t i = 0; i < kPoses; ++i) {
      const Isometry3d held = ideal(all[i]);
      const double off_mm = (held.translation() - real[i].translation()).norm();
      sum += off_mm * off_mm;
      file.worst_um = std::max(file.worst_um, maths::kUmPerMm * off_mm);
      const Vector3d tilt = held.rotation().col(2).cross(real[i].rotation().col(2));
      file.worst_urad = std::max(file.worst_urad, 1e6 * tilt.norm());
    }
    file.rms_um = maths::kUmPerMm * std::sqrt(sum / kPoses);
    file.rms_nominal_um = maths::kUmPerMm * rms_aligned_mm(nominal, real);
    file.positions = kPoses;
    file.measured = machine_.fitted && !machine_.fitted->measured.empty();
  }

  static std::string origin(const Isometry3d& frame) {
    return fmt::format("    <origin xyz=\"{}\" rpy=\"{}\"/>\n", format::origin_xyz(frame),
                       format::origin_rpy(frame));
  }

  /// The numbers of a unit vector.
  static std::string triple(const Vector3d& v) {
    Isometry3d as_metres = Isometry3d::Identity();
    as_metres.translation() = 1000 * v;
    return format::origin_xyz(as_metres);
  }

  std::string limits_of(const model::Axis& axis) const {
    const double unit = axis.rotary ? maths::kDegPerRad : 1000;
    if (!axis.min || !axis.max) return {};
    return fmt::format("    <limit lower=\"{:.12g}\" upper=\"{:.12g}\" effort=\"0\" velocity=\"0\"/>\n",
                       *axis.min / unit, *axis.max / unit);
  }

  static std::string comment_of(const std::vector<UndeterminedJoint>& undetermined) {
    if (undetermined.empty()) return {};
    return fmt::format(
        "<!-- The readings of the fit do not determine these joints completely; their values are set by "
        "convention or prior:\n     {}.\n     Other values of the same joints give the same positions of the "
        "tool in the survey. -->\n",
        joints_text(undetermined));
  }

  /// The original with its calibrated joints, and before the robot a comment that says so.
  std::string with_comment(const CalibratedOriginal& original,
                           const std::vector<UndeterminedJoint>& undetermined) const {
    std::string text = original.text;
    pugi::xml_document document;
    document.load_buffer(text.data(), text.size());
    const auto robot = static_cast<std::size_t>(document.child("robot").offset_debug());
    text.insert(robot - 1,  // before its "<"
                fmt::format("<!-- Calibrated origins of the joints: machine file {}. The tool point of the "
                            "machine file is at xyz \"{}\" (m) in the link {}. -->\n{}",
                            machine_.name, triple(Vector3d(original.tool_mm.data()) / 1000), original.tip,
                            comment_of(undetermined)));
    return text;
  }

  std::string text(const std::vector<UndeterminedJoint>& undetermined) const {
    const std::string open = comment_of(undetermined);
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
      const std::string& name = names_[joint.axis];
      const std::string child = "link_" + name;
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
          child, name,
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
                      "  <link name=\"{0}\"/>\n  <joint name=\"{0}_joint\" type=\"fixed\">\n{1}    <parent "
                      "link=\"{2}\"/>\n    <child link=\"{0}\"/>\n  </joint>\n</robot>\n",
                      kToolLink, origin(tool), parent);
  }

  const model::Machine& machine_;
  const model::States& at_;
  std::vector<std::string> names_;  // of the joints, an entry for each axis
  Joints reference_;
  std::vector<Joint> joints_;
  Isometry3d at_reference_;
};

}  // namespace

UrdfFile urdf_arm(const model::Machine& machine, const model::States& at,
                  const std::vector<std::string>& joints, const UrdfOriginal* original) {
  return Arm(machine, at, joints).file(original);
}

std::vector<std::string> joint_names(const model::Machine& machine, const std::string& text) {
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size());
  const pugi::xml_node axes = document.find_node(
      [](const pugi::xml_node& node) { return text::equal_no_case(node.name(), "machineaxes"); });
  std::vector<std::string> names;
  for (const model::Axis& axis : machine.axes)
    names.emplace_back(axes.child(axis.name.c_str()).attribute("joint").as_string(axis.name.c_str()));
  return names;
}

}  // namespace vernier::exchange
