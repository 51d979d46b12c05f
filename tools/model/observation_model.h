// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/chain_rows.h"
#include "tools/model/measurement.h"

namespace vernier {

/// What the observations of one row should read, given the tool's pose in workpiece coordinates and the
/// BaseShift of the row's run (null: identity). Keeps references. tool.
class ObservationModel {
 public:
  ObservationModel(const Measurement& measurement, const BaseShift* shift, const Frame& pose);

  /// mm, or deg for rotations: of the rotation vectors that repeat every 360 deg the one nearest to the
  /// reading.
  double predicted(const Observation& observation);

  /// How the observation answers to a motion of the tool in the measuring frame: point . gradient.point (mm)
  /// + rotation . gradient.rotation (rad). For a rotation: after predicted() of an observation of this row.
  Twist gradient(const Observation& observation) const;

  /// Twists of the tool in the measuring frame by the six components of the BaseShift.
  std::array<Twist, 6> base_twists() const { return sixdof_twists(base_value_, point_); }
  const Eigen::Matrix3d& base_rotation() const { return base_.rotation; }

 private:
  Eigen::Vector3d normal(Eigen::Index row) const;
  const Eigen::Vector3d& rotation_vector(std::size_t row);

  const Measurement& m_;
  const Frame& pose_;
  Frame base_;
  std::array<double, 6> base_value_{};
  Eigen::Vector3d point_, phi_ = Eigen::Vector3d::Zero();  // measuring frame: mm, rad
  bool has_phi_ = false;
};

}  // namespace vernier
