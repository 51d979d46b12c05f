// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>

#include "tools/model/chain/chain_rows.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::model {

/// Predicts the observations of one row from the pose of the tool in workpiece coordinates, and from the
/// BaseShift and the ToolShift of the row's set-up. A reading that does not depend on the set-up is a reading
/// of the tool itself. Every other reading is of the object that the ToolShift places in the frame of the
/// tool. `gravity`: direction of gravity in the machine file, as a unit vector. The ObservationModel keeps
/// references to its arguments.
class ObservationModel {
 public:
  ObservationModel(const Measurement& measurement, const std::array<double, 3>& gravity,
                   const SetUpOfRow& set_up, const Frame& pose);

  /// Returns the measured point in the measuring frame, mm: the tool point moved by the ToolShift.
  const Eigen::Vector3d& point() const { return seen_.origin; }
  /// Sets the position of the other end of a distance reading. For a distance reading, call set_other_end()
  /// before predicted().
  void set_other_end(const Eigen::Vector3d& point) { other_end_ = point; }

  /// Returns the predicted value of an observation: mm, or deg for rotations. Rotation vectors that differ by
  /// 360 deg are equivalent. Of the equivalent rotation vectors, the vector nearest to the reading is the
  /// prediction. For a board, the predicted rotation is the reading minus the small rotation from the
  /// prediction to the reading, about the axes of the camera. The residual is therefore this small rotation
  /// vector, for any orientation of the board.
  double predicted(const Observation& observation);

  /// Returns the sensitivity of an observation to a motion of the tool in the measuring frame. The change of
  /// the observation is point . gradient.point (mm) + rotation . gradient.rotation (rad). `point` is the
  /// motion of the tool point, also if the set-up has a ToolShift. For a rotation reading, call predicted()
  /// for an observation of the same row before gradient().
  Twist gradient(const Observation& observation) const;

  /// Returns the motions (twists) of the tool in the measuring frame by the six components of the BaseShift.
  std::array<Twist, 6> base_twists() const { return sixdof_twists(base_value_, point_); }
  /// Returns the motions (twists) of the tool in the measuring frame that have the same effect as the six
  /// components of the ToolShift.
  std::array<Twist, 6> tool_twists() const;
  const Eigen::Matrix3d& base_rotation() const { return base_.rotation; }

 private:
  Eigen::Vector3d normal(Eigen::Index row) const;
  const Eigen::Vector3d& rotation_vector(std::size_t row);
  /// Returns the measured direction and two directions perpendicular to it. If the row has no measured
  /// direction, sight() returns the axes of the tool.
  Eigen::Matrix3d sight(Eigen::Index row) const;
  /// Returns the small rotation vector from the predicted to the measured rotation of the board, about the
  /// axes of the camera, rad.
  const Eigen::Vector3d& board_error(std::size_t row);
  /// Returns the measured rotation vector of a row, from the reading kinds first, first + 1 and first + 2,
  /// rad.
  Eigen::Vector3d measured_rotation(std::size_t row, ObservationKind first) const;
  /// Returns the direction of the tool axis (z axis of the measured object) in the measuring frame.
  Eigen::Vector3d tool_axis() const { return seen_.rotation.col(2); }
  /// Returns the sensitivity of a reading that depends on the set-up to a motion of the measured object.
  Twist gradient_of_seen(const Observation& observation) const;

  const Measurement& m_;
  const Frame& pose_;
  Eigen::Vector3d up_;
  Frame base_;
  std::array<double, 6> base_value_{};
  Frame seen_;                          // frame of the measured object in the measuring frame
  std::array<double, 6> tool_value_{};  // values of the ToolShift
  bool has_tool_shift_ = false;
  Eigen::Vector3d point_, phi_ = Eigen::Vector3d::Zero();  // in the measuring frame: mm, rad
  Eigen::Vector3d board_error_ = Eigen::Vector3d::Zero();  // about the axes of the camera, rad
  Eigen::Vector3d other_end_ = Eigen::Vector3d::Zero();    // position of the other end of a distance, mm
  bool has_phi_ = false, has_board_error_ = false;
};

}  // namespace vernier::model
