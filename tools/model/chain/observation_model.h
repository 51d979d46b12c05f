// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/chain/chain_rows.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::model {

/// Predicts the observations of one row from the tool's pose in workpiece coordinates and the two places of
/// the row's set-up. Readings that do not depend on the set-up are of the tool itself; all others are of what
/// the ToolShift places in the frame of the tool. gravity: direction of gravity in the machine file, unit
/// vector. Keeps references.
class ObservationModel {
 public:
  ObservationModel(const Measurement& measurement, const std::array<double, 3>& gravity,
                   const SetUpOfRow& set_up, const Frame& pose);

  /// Returns the measured point in the measuring frame, mm: the tool point moved by the ToolShift.
  const Eigen::Vector3d& point() const { return seen_.origin; }
  /// Sets the position of the other end of the row's distance. Call set_other_end() before predicted() of a
  /// distance.
  void set_other_end(const Eigen::Vector3d& point) { other_end_ = point; }

  /// Returns the predicted value: mm, or deg for rotations. Rotation vectors repeat every 360 deg. The vector
  /// nearest to the reading is used. The predicted rotation of a board is the reading minus the small
  /// rotation, about the axes of the camera, from the prediction to the reading: the residual is this
  /// rotation vector for any orientation, and equal uncertainties about three axes are equal for all
  /// readings.
  double predicted(const Observation& observation);

  /// Returns the sensitivity of the observation to a motion of the tool in the measuring frame: point .
  /// gradient.point (mm) + rotation . gradient.rotation (rad). `point` is the motion of the tool point, also
  /// with a ToolShift. For a rotation, call predicted() of an observation of this row before this function.
  Twist gradient(const Observation& observation) const;

  /// Twists of the tool in the measuring frame by the six components of the BaseShift.
  std::array<Twist, 6> base_twists() const { return sixdof_twists(base_value_, point_); }
  /// Twists of the tool in the measuring frame that have the effect of the six components of the ToolShift.
  std::array<Twist, 6> tool_twists() const;
  const Eigen::Matrix3d& base_rotation() const { return base_.rotation; }

 private:
  Eigen::Vector3d normal(Eigen::Index row) const;
  const Eigen::Vector3d& rotation_vector(std::size_t row);
  /// Returns the measured direction and two directions across it. If the row has no measured direction,
  /// sight() uses the axes of the tool.
  Eigen::Matrix3d sight(Eigen::Index row) const;
  /// Returns the rotation vector, rad, from the predicted to the measured rotation of the board, about the
  /// axes of the camera.
  const Eigen::Vector3d& board_error(std::size_t row);
  /// Returns the measured rotation vector of the kinds first, first + 1 and first + 2 in this row, rad.
  Eigen::Vector3d measured_rotation(std::size_t row, ObservationKind first) const;
  /// Returns the axis of the tool (z of what is measured) in the measuring frame.
  Eigen::Vector3d tool_axis() const { return seen_.rotation.col(2); }
  /// gradient() of a reading that depends on the set-up, by a motion of what is measured.
  Twist gradient_of_seen(const Observation& observation) const;

  const Measurement& m_;
  const Frame& pose_;
  Eigen::Vector3d up_;
  Frame base_;
  std::array<double, 6> base_value_{};
  Frame seen_;                          // what is measured, in the measuring frame
  std::array<double, 6> tool_value_{};  // of the ToolShift
  bool has_tool_shift_ = false;
  Eigen::Vector3d point_, phi_ = Eigen::Vector3d::Zero();  // measuring frame: mm, rad
  Eigen::Vector3d board_error_ = Eigen::Vector3d::Zero();  // axes of the camera, rad
  Eigen::Vector3d other_end_ = Eigen::Vector3d::Zero();    // mm
  bool has_phi_ = false, has_board_error_ = false;
};

}  // namespace vernier::model
