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

/// Correction of one axis by the position of one axis: values at equal distances, mm, added to the command.
struct ControllerTable {
  std::size_t input = 0, output = 0;  // 0 X, 1 Y, 2 Z
  double from = 0, step = 1;          // position of the first value and distance of the values, mm
  bool stairs = false;                // the nearest value applies; else a straight line between two values
  std::vector<double> forward, reverse;

  double position(std::size_t point) const { return from + static_cast<double>(point) * step; }
  /// Value at a position of the input axis; the end values are used outside. direction < 0: reverse.
  double at(double position_mm, double direction) const;
};

/// The tables of a machine. Each is zero at the reference position (mean of both directions).
struct ControllerTables {
  std::vector<ControllerTable> tables;
  /// Correction in the positive minus the negative direction, one number for an axis, mm. 0 if the tables
  /// have values for each direction.
  std::array<double, 3> reversal{};
  std::array<double, 3> reference{};   // positions at which the tables are zero, mm
  std::array<double, 3> between_um{};  // largest error between the points of the tables of an input axis

  /// Table of an input and an output axis; nullptr if it is not written.
  const ControllerTable* find(std::size_t input, std::size_t output) const;
  /// Commands of X, Y and Z with the corrections, a column each, mm. directions: -1 or +1 of each command.
  Eigen::Matrix3Xd corrected(const Eigen::Matrix3Xd& commands, const Eigen::Matrix3Xd& directions) const;
};

/// Returns the states at commands of X, Y and Z, a column each, mm, and directions from -1 to +1 of each.
model::States controller_states(const ThreeAxes& axes, const Eigen::Matrix3Xd& commands,
                                const Eigen::Matrix3Xd& directions, const model::States& at);

/// Errors of the tool point at positions of the whole volume, without the mean offset, um.
struct ControllerErrors {
  std::array<double, 3> before_um{}, after_um{};  // largest of X, Y and Z
  /// Largest error along an axis that arrived in its positive or negative direction.
  std::array<double, 3> after_positive_um{}, after_negative_um{};
  double rms_before_um = 0, rms_after_um = 0;  // of the three directions together
  std::size_t positions = 0;
};

/// Evaluates the chain with the corrected commands at positions between the points (4096, fixed seed), each
/// axis in a random direction.
ControllerErrors controller_errors(const model::Machine& machine, const ThreeAxes& axes,
                                   const ControllerTables& tables, const model::States& at);

}  // namespace vernier::exchange
