// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace vernier::format {

/// A joint of a URDF file (Unified Robot Description Format, wiki.ros.org/urdf/XML).
struct UrdfJoint {
  std::string name, type, parent, child;  // type as in the file; parent and child are links
  /// Frame of the joint, at the variable 0, in the frame of the parent link; mm
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // unit vector in the frame of the joint
  std::optional<double> lower, upper;               // rad or m, as in the file
  bool mimic = false;
  std::size_t line = 0;
  bool moves() const { return type != "fixed"; }
  bool slides() const { return type == "prismatic"; }
};

/// The links and joints of a URDF file. The functions and the constructor throw InputError with file, line
/// and word for: text that is not URDF, an xacro that is not expanded, a link that does not exist, links that
/// close a loop.
class UrdfTree {
 public:
  UrdfTree(const std::string& text, const std::string& file);

  const std::string& name() const { return name_; }

  /// Returns the joints from the root link to a link. Empty for the root link.
  std::vector<UrdfJoint> way_to(const std::string& link) const;

  /// Returns the end links of the chains with the most moving joints, by name. Throws InputError if no joint
  /// moves.
  std::vector<std::string> ends() const;

  /// Returns the end link of the chain with the most moving joints. Throws InputError if there are several.
  std::string only_end() const;

  void require_link(const std::string& name) const;

 private:
  std::string name_, file_;
  std::vector<UrdfJoint> joints_;
  std::set<std::string> links_;
  std::map<std::string, std::size_t> above_;  // the joint above each link
};

/// A straight line: an axis of a joint.
struct JointLine {
  Eigen::Vector3d point, direction;  // mm; unit vector
};

/// Returns the frame of the first row of Denavit and Hartenberg in the frame of the root link: z along the
/// axis of the first joint, the origin at the root if the axis goes through it.
Eigen::Isometry3d first_row_frame(const JointLine& first_axis);

/// Returns the attributes of `<origin>` for a frame: xyz in m, rpy in rad about fixed axes X, Y, Z.
std::string origin_xyz(const Eigen::Isometry3d& frame_mm);
std::string origin_rpy(const Eigen::Isometry3d& frame_mm);

/// Returns a URDF text with other origins of joints (name of the joint; mm). All other characters of the text
/// remain. `text`: a text that UrdfTree accepted. Throws InputError if a joint of that name is not in the
/// text.
std::string with_origins(const std::string& text, const std::string& file,
                         const std::map<std::string, Eigen::Isometry3d>& origins_mm);

}  // namespace vernier::format
