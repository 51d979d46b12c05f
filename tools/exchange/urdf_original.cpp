// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/urdf_original.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/text/error.h"

namespace vernier::exchange {
namespace {

using Eigen::Index;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using format::JointLine;
using format::UrdfJoint;

constexpr double kLever_mm = 100;  // a rotation counts as the motion of a point so far away

/// A moving joint of the original, and the fixed joints before it.
struct Link {
  UrdfJoint joint;
  Isometry3d before = Isometry3d::Identity();  // from the last moving joint to the parent link of this joint
};

/// The way from the root to the tip: moving joints, and the fixed joints behind the last of them.
struct Way {
  std::vector<Link> links;
  std::vector<UrdfJoint> behind;
  Isometry3d to_tip() const {
    Isometry3d frame = Isometry3d::Identity();
    for (const UrdfJoint& one : behind) frame = frame * one.origin;
    return frame;
  }
};

Way way_of(const std::vector<UrdfJoint>& joints) {
  Way way;
  Isometry3d before = Isometry3d::Identity();
  for (const UrdfJoint& joint : joints) {
    if (joint.moves()) {
      way.links.push_back({joint, before});
      way.behind.clear();
      before = Isometry3d::Identity();
    } else {
      way.behind.push_back(joint);
      before = before * joint.origin;
    }
  }
  return way;
}

/// Frames of the moving joints of the original at 0, in the root link.
std::vector<Isometry3d> frames_of(const Way& way) {
  std::vector<Isometry3d> frames;
  Isometry3d at = Isometry3d::Identity();
  for (const Link& link : way.links) frames.push_back(at = at * link.before * link.joint.origin);
  return frames;
}

JointLine moved(const Isometry3d& by, const JointLine& line) {
  return {by * line.point, by.linear() * line.direction};
}

/// Throws InputError if the axes of the nominal arm are not those of the original.
void require_same(const UrdfOriginal& original, const Way& way, const IdealArm& nominal,
                  const Isometry3d& base) {
  constexpr double kSame_mm = 1e-3, kSame = 1e-6;  // mm, rad: digits of a machine file
  const std::string remedy =
      "; make the machine file from this URDF (vernier new --urdf), or export without --original";
  std::vector<std::string> names;
  for (const Link& link : way.links) names.push_back(link.joint.name);
  for (std::size_t i = 0; i < std::max(names.size(), nominal.joints.size()); ++i) {
    const std::string here = i < names.size() ? names[i] : "none";
    const std::string machine = i < nominal.joints.size() ? nominal.joints[i] : "none";
    if (here != machine)
      throw text::InputError({original.file, i < names.size() ? way.links[i].joint.line : 1}, here,
                             fmt::format("joint {} of the machine file is {}{}", i + 1, machine, remedy));
  }
  const std::vector<Isometry3d> frames = frames_of(way);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const UrdfJoint& joint = way.links[i].joint;
    const JointLine axis = moved(base, nominal.axes[i]);
    const Vector3d direction = frames[i].linear() * joint.axis;
    const double turned = (axis.direction - direction).norm();
    const double away = joint.slides() ? 0 : direction.cross(axis.point - frames[i].translation()).norm();
    if (turned > kSame || away > kSame_mm)
      throw text::InputError(
          {original.file, joint.line}, joint.name,
          fmt::format("the axis of this joint is {:.3g} mm and {:.3g} deg from the axis in "
                      "the nominal machine file{}",
                      away, turned * maths::kDegPerRad, remedy));
  }
}

/// The frames of the calibrated joints, each on its axis, with the least change of the origins.
class Placing {
 public:
  Placing(const Way& way, std::vector<JointLine> axes, const Isometry3d& tip)
      : way_(way), axes_(std::move(axes)), tip_(tip) {
    start();
    settle();
  }

  /// Frame of a moving joint in the root link.
  const Isometry3d& frame(std::size_t i) const { return frames_[i]; }
  /// Calibrated origin of a moving joint in its parent link.
  Isometry3d origin(std::size_t i) const {
    const Isometry3d parent = (i == 0 ? Isometry3d::Identity() : frames_[i - 1]) * way_.links[i].before;
    return parent.inverse() * frames_[i];
  }

 private:
  /// Each joint at the point of its axis that is nearest to its place behind the joint before it.
  void start() {
    Isometry3d at = Isometry3d::Identity();
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const Link& link = way_.links[i];
      at = at * link.before * link.joint.origin;
      const Vector3d& direction = axes_[i].direction;
      at.linear() =
          Eigen::Quaterniond::FromTwoVectors(at.linear() * link.joint.axis, direction) * at.linear();
      if (!link.joint.slides()) {
        const Vector3d from = at.translation() - axes_[i].point;
        at.translation() = axes_[i].point + direction.dot(from) * direction;
      }
      frames_.push_back(at);
      for (Index k = 0; k < (link.joint.slides() ? 4 : 2); ++k) values_.emplace_back(i, k);
    }
  }

  /// Turns a joint about its axis (value 0), or shifts its frame along the axis (1; a slide: 1 to 3, along
  /// the axes of the frame); mm.
  void move(const std::pair<std::size_t, Index>& value, double by) {
    const UrdfJoint& joint = way_.links[value.first].joint;
    Isometry3d& frame = frames_[value.first];
    if (value.second == 0)
      frame.rotate(Eigen::AngleAxisd(by / kLever_mm, joint.axis));
    else
      frame.translate(by * (joint.slides() ? Vector3d(Vector3d::Unit(value.second - 1)) : joint.axis));
  }

  static void add(const Isometry3d& is, const Isometry3d& was, Index at, Eigen::VectorXd& list) {
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(was.linear().transpose() * is.linear()));
    list.segment<3>(at) = is.translation() - was.translation();
    list.segment<3>(at + 3) = kLever_mm * turn.angle() * turn.axis();
  }

  /// Changes of the origins and of the way to the tip, six values each, mm.
  Eigen::VectorXd changes() const {
    Eigen::VectorXd list(6 * static_cast<Index>(frames_.size() + 1));
    for (std::size_t i = 0; i < frames_.size(); ++i)
      add(origin(i), way_.links[i].joint.origin, 6 * static_cast<Index>(i), list);
    add(frames_.back().inverse() * tip_, way_.to_tip(), 6 * static_cast<Index>(frames_.size()), list);
    return list;
  }

  /// Steps of least squares; the changes are small.
  void settle() {
    constexpr int kSteps = 5;
    constexpr double kStep_mm = 1e-4;
    for (int step = 0; step < kSteps; ++step) {
      const Eigen::VectorXd now = changes();
      const std::vector<Isometry3d> frames = frames_;
      Eigen::MatrixXd slope(now.size(), static_cast<Index>(values_.size()));
      for (std::size_t k = 0; k < values_.size(); ++k) {
        move(values_[k], kStep_mm);
        slope.col(static_cast<Index>(k)) = (now - changes()) / kStep_mm;
        frames_ = frames;
      }
      const Eigen::VectorXd by = maths::least_norm(slope, now);
      for (std::size_t k = 0; k < values_.size(); ++k) move(values_[k], by[static_cast<Index>(k)]);
      if (changes().norm() < now.norm()) continue;
      frames_ = frames;
      return;
    }
  }

  const Way& way_;
  std::vector<JointLine> axes_;
  Isometry3d tip_;
  std::vector<Isometry3d> frames_;
  std::vector<std::pair<std::size_t, Index>> values_;
};

bool same(const Isometry3d& a, const Isometry3d& b) {
  constexpr double kSame_mm = 1e-6;  // digits of a machine file
  return (a.translation() - b.translation()).norm() < kSame_mm &&
         kLever_mm * (a.linear() - b.linear()).norm() < kSame_mm;
}

/// A fixed joint and a link more, before the end of the robot.
void add_tip(std::string& text, const std::string& parent, const std::string& tip, const Isometry3d& frame) {
  text.insert(text.rfind("</robot>"),
              fmt::format("  <link name=\"{0}\"/>\n  <joint name=\"{0}_joint\" type=\"fixed\">\n    <origin "
                          "xyz=\"{2}\" rpy=\"{3}\"/>\n    <parent link=\"{1}\"/>\n    <child "
                          "link=\"{0}\"/>\n  </joint>\n",
                          tip, parent, format::origin_xyz(frame), format::origin_rpy(frame)));
}

}  // namespace

CalibratedOriginal calibrated_original(const UrdfOriginal& original, const IdealArm& calibrated,
                                       const IdealArm& nominal) {
  const format::UrdfTree tree(original.text, original.file);
  CalibratedOriginal result;
  result.tip = original.tip.empty() ? tree.only_end() : original.tip;
  tree.require_link(result.tip);
  const Way way = way_of(tree.way_to(result.tip));
  if (way.links.empty())
    throw text::InputError({original.file, 1}, result.tip, "no joint between the root and this link moves");
  const std::vector<Isometry3d> frames = frames_of(way);
  const UrdfJoint& first = way.links.front().joint;
  const Isometry3d base =
      format::first_row_frame({frames.front().translation(), frames.front().linear() * first.axis});
  require_same(original, way, nominal, base);

  // The tip link is rigid with the last row: its place there is that of the nominal arm.
  const Isometry3d in_last = (base * nominal.last).inverse() * frames.back() * way.to_tip();
  const Isometry3d tip = base * calibrated.last * in_last;
  std::vector<JointLine> axes;
  for (const JointLine& axis : calibrated.axes) axes.push_back(moved(base, axis));
  const Placing placing(way, std::move(axes), tip);

  std::map<std::string, Isometry3d> origins;
  for (std::size_t i = 0; i < way.links.size(); ++i)
    if (!same(placing.origin(i), way.links[i].joint.origin))
      origins.emplace(way.links[i].joint.name, placing.origin(i));
  const Isometry3d behind = placing.frame(way.links.size() - 1).inverse() * tip;
  if (!way.behind.empty() && !same(behind, way.to_tip()))
    origins.emplace(way.behind.front().name,
                    behind * (way.behind.front().origin.inverse() * way.to_tip()).inverse());
  result.text = format::with_origins(original.text, original.file, origins);
  if (way.behind.empty() && !same(behind, way.to_tip())) {
    const std::string parent = result.tip;
    result.tip += "_calibrated";
    result.added_tip = true;
    add_tip(result.text, parent, result.tip, behind);
  }
  const Vector3d tool =
      in_last.inverse() * Vector3d(calibrated.tool_mm[0], calibrated.tool_mm[1], calibrated.tool_mm[2]);
  result.tool_mm = {tool.x(), tool.y(), tool.z()};
  return result;
}

}  // namespace vernier::exchange
