// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "tools/exchange/three_axes.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::exchange {

/// Correction of one axis as a function of the position of one axis: values at equal distances, mm, which are
/// added to the command.
struct ControllerTable {
  std::size_t input = 0, output = 0;  // index of an axis: 0 X, 1 Y, 2 Z
  double from = 0, step = 1;          // position of the first value, and distance between the values, mm
  bool stairs = false;                // true: the nearest value is used; false: linear interpolation between
                                      // two values
  std::vector<double> forward, reverse;
  double low = -1e9, high = 1e9;  // travel of the input axis, mm; the first and last point can be outside it

  double position(std::size_t point) const { return from + static_cast<double>(point) * step; }
  /// Returns the value at a position of the input axis. Outside the table, the first or last value is used.
  /// If the direction of motion is negative (direction < 0), the values `reverse` are used.
  double at(double position_mm, double direction) const;
};

/// A straightness that the last fit does not determine: its table has the straight line only.
struct UncertainShape {
  std::size_t input = 0, output = 0;  // as in ControllerTable
  double um = 0;                      // rms of the shape that is left out
  double std_um = 0;                  // its standard uncertainty, rms
};

/// All compensation tables of a machine. Each table is zero at the reference position (mean of both
/// directions).
struct ControllerTables {
  std::vector<ControllerTable> tables;
  /// Correction in the positive direction minus correction in the negative direction, one number for each
  /// axis, mm. The reversal is 0 if the tables have separate values for each direction.
  std::array<double, 3> reversal{};
  std::array<double, 3> reference{};   // reference position at which the tables are zero, mm
  std::array<double, 3> between_um{};  // for each input axis: largest error between the points of its tables
  std::vector<UncertainShape> uncertain;

  /// Returns the table for an input axis and an output axis; nullptr if there is no such table.
  const ControllerTable* find(std::size_t input, std::size_t output) const;
  /// Returns the commands of X, Y and Z with the corrections added, one column for each command, mm.
  /// `directions`: direction of motion for each command, -1 or +1.
  Eigen::Matrix3Xd corrected(const Eigen::Matrix3Xd& commands, const Eigen::Matrix3Xd& directions) const;
};

/// Returns the states of the machine at commands of X, Y and Z (one column for each command, mm).
/// `directions`: -1 to +1 for each command.
model::States controller_states(const ThreeAxes& axes, const Eigen::Matrix3Xd& commands,
                                const Eigen::Matrix3Xd& directions, const model::States& at);

/// Errors of the tool point at positions in the whole volume, without their mean, um.
struct ControllerErrors {
  std::array<double, 3> before_um{}, after_um{};  // largest error in X, Y and Z
  /// Largest error along an axis after a motion of this axis in its positive or negative direction.
  std::array<double, 3> after_positive_um{}, after_negative_um{};
  double rms_before_um = 0, rms_after_um = 0;  // rms error of X, Y and Z together
  std::size_t positions = 0;
  /// Rotation of the whole part that the tables correct, about X, Y and Z: the travel of X is its direction,
  /// and the travel of Y is in the plane XY. No dimension of a part depends on it.
  std::array<double, 3> rotation_urad{};
  double rotation_um = 0;  // largest motion by this rotation about the middle of the volume
};

/// Computes the errors with the chain at corrected commands. The errors are evaluated at 4096 positions
/// between the points of the tables (fixed seed), each axis with a random direction.
ControllerErrors controller_errors(const model::Machine& machine, const ThreeAxes& axes,
                                   const ControllerTables& tables, const model::States& at);

}  // namespace vernier::exchange
