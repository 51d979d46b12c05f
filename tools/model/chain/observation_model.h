// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/chain/chain_rows.h"
#include "tools/model/measurement.h"

namespace vernier::model {

/// Predicts the observations of one row from the tool's pose in workpiece coordinates and the
/// BaseShift of the row's set-up (null: identity). gravity: direction of gravity in the machine file, unit
/// vector. Keeps references.
class ObservationModel {
 public:
  ObservationModel(const Measurement& measurement, const std::array<double, 3>& gravity,
                   const BaseShift* shift, const Frame& pose);

  /// Returns the tool point in the measuring frame, mm.
  const Eigen::Vector3d& point() const { return point_; }
  /// Sets the position of the other end of the row's distance. Call set_other_end() before predicted() of a
  /// distance.
  void set_other_end(const Eigen::Vector3d& point) { other_end_ = point; }

  /// Returns the predicted value: mm, or deg for rotations. Rotation vectors repeat every 360 deg. The vector
  /// nearest to the reading is used.
  double predicted(const Observation& observation);

  /// Returns the sensitivity of the observation to a motion of the tool in the measuring frame: point .
  /// gradient.point (mm) + rotation . gradient.rotation (rad). For a rotation, call predicted() of an
  /// observation of this row before this function.
  Twist gradient(const Observation& observation) const;

  /// Twists of the tool in the measuring frame by the six components of the BaseShift.
  std::array<Twist, 6> base_twists() const { return sixdof_twists(base_value_, point_); }
  const Eigen::Matrix3d& base_rotation() const { return base_.rotation; }

 private:
  Eigen::Vector3d normal(Eigen::Index row) const;
  const Eigen::Vector3d& rotation_vector(std::size_t row);
  /// Returns the measured direction and two directions across it. If the row has no measured direction,
  /// sight() uses the axes of the tool.
  Eigen::Matrix3d sight(Eigen::Index row) const;
  /// Returns the tool axis (z of the tool's frame) in the measuring frame.
  Eigen::Vector3d tool_axis() const { return base_.rotation * pose_.rotation.col(2); }

  const Measurement& m_;
  const Frame& pose_;
  Eigen::Vector3d up_;
  Frame base_;
  std::array<double, 6> base_value_{};
  Eigen::Vector3d point_, phi_ = Eigen::Vector3d::Zero();  // measuring frame: mm, rad
  Eigen::Vector3d other_end_ = Eigen::Vector3d::Zero();    // mm
  bool has_phi_ = false;
};

}  // namespace vernier::model
