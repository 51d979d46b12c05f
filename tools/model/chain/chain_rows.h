// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/model/chain/evaluate.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::model {

/// A coordinate frame: rotation and origin, in the coordinates of the previous frame of the chain.
struct Frame {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // mm
};

/// Motion of a rigid body per unit of a parameter: velocity of the tool point (mm per unit) and angular
/// velocity (rad per unit).
struct Twist {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
};

/// Returns the frame of a sixdof transform, T(X,Y,Z)*Rx(rX)*Ry(rY)*Rz(rZ); values in mm and deg.
Frame sixdof_frame(const std::array<double, 6>& value);

/// Returns the twist (motion) of a point by each of the six degrees of freedom, per mm or per deg, in the
/// frame of `value`. `point`: coordinates of the moved point in this frame.
std::array<Twist, 6> sixdof_twists(const std::array<double, 6>& value, const Eigen::Vector3d& point);

/// The chain of a machine, evaluated at states. The values of the degrees of freedom are computed once, for
/// all states. The function pose() then computes the pose of one state.
class ChainRows {
 public:
  /// `active`: flags of the derivatives that pose() returns as twists, as for Evaluator. Throws InputError if
  /// the value of an expression is not finite. The message of the error names the transform, the degree of
  /// freedom and the row.
  ChainRows(const Machine& machine, const States& states, std::vector<char> active = {});

  /// Returns the tool frame in workpiece coordinates at state i.
  Frame pose(std::size_t i) const;

  /// Returns the pose of state i, and the twist of the tool point by each active parameter, in workpiece
  /// coordinates. keys() returns the parameter key of each entry of `twists`.
  Frame pose(std::size_t i, std::vector<Twist>& twists) const;
  const std::vector<std::size_t>& keys() const { return keys_; }

 private:
  struct Dof {
    Value value;
    std::vector<std::pair<std::size_t, Value>> by;  // position in keys_, and derivative
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
