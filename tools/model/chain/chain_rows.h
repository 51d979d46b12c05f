// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/model/chain/evaluate.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::model {

/// A frame: rotation and origin, in the coordinates of the frame below.
struct Frame {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // mm
};

/// Motion of a rigid body per unit of a parameter: velocity of the tool point (mm) and angular
/// velocity (rad).
struct Twist {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
};

/// Returns the frame of a sixdof, T(X,Y,Z)*Rx(rX)*Ry(rY)*Rz(rZ); mm and deg.
Frame sixdof_frame(const std::array<double, 6>& value);

/// Returns the twists of a point per mm and per deg of the six degrees of freedom, in the frame of
/// `value`. `point`: the moved point in that frame.
std::array<Twist, 6> sixdof_twists(const std::array<double, 6>& value, const Eigen::Vector3d& point);

/// The chain of a machine, evaluated at states. The columns of the degrees of freedom are computed once. A
/// pose is then computed for each state.
class ChainRows {
 public:
  /// `active` as for Evaluator: the derivatives that twists() reports. Throws InputError if an
  /// expression is not finite. The message names transform, degree of freedom and row.
  ChainRows(const Machine& machine, const States& states, std::vector<char> active = {});

  /// Returns the tool frame in workpiece coordinates at state i.
  Frame pose(std::size_t i) const;

  /// Returns the pose of state i and the twist of the tool point in workpiece coordinates by each active key.
  /// `keys()` gives the key of each entry of `twists`.
  Frame pose(std::size_t i, std::vector<Twist>& twists) const;
  const std::vector<std::size_t>& keys() const { return keys_; }

 private:
  struct Dof {
    Value value;
    std::vector<std::pair<std::size_t, Value>> by;  // position in keys_, derivative
  };
  struct Link {
    TransformKind kind;
    std::array<Dof, 6> dof;
  };
  Link link(const Transform& transform, const char* branch, Evaluator& evaluate);
  static Frame frame_of(const Link& link, std::size_t i);
  static void add_twists(const Link& link, std::size_t i, const Frame& below, const Eigen::Vector3d& tip,
                         const Eigen::Matrix3d& to_workpiece, double sense, std::vector<Twist>& twists);

  const Machine& machine_;
  std::size_t count_;
  std::vector<Link> tool_, workpiece_;
  std::vector<std::size_t> keys_;
};

}  // namespace vernier::model
