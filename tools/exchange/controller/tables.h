// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "tools/exchange/printer/correction.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::exchange {

/// Names of the axes of a table.
inline constexpr std::array<const char*, 3> kLetters = {"X", "Y", "Z"};

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

/// What a controller holds, and its limits.
struct ControllerRules {
  std::size_t most_own = 2, most_cross = 0;  // points of a table; most_cross 0: no tables of other axes
  bool own_reverse = false;                  // own tables have values of their own in the negative direction
  bool same_points = false;                  // all tables of an input axis share their positions
  bool stairs = false;
  double value_step_mm = 1e-6;     // resolution of the values
  double position_step_mm = 1e-6;  // resolution of the positions
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

/// What the user states about the tables.
struct ControllerWishes {
  double tolerance_um = 1;            // error between the points at which the number of points is enough
  double step_mm = 0;                 // distance of the points; 0: chosen by the tolerance
  std::array<double, 3> reference{};  // position at which the tables are zero, mm
};

/// Returns the tables that hold the corrections of a machine as sums of functions of one axis: the mean of
/// the corrections over positions of the other axes. Values and positions are rounded as the files have
/// them. Without step_mm, the number of points grows until the error between them is within the tolerance or
/// the controller's limit is reached. Tables of other axes below a quarter of the tolerance are left out.
/// `at` (count 1): inputs and motion. Throws InputError: step_mm needs more points than the controller keeps.
/// tool.
ControllerTables controller_tables(const model::Machine& machine, const PrinterAxes& axes,
                                   const ControllerRules& rules, const model::States& at,
                                   const ControllerWishes& wishes);

/// Errors of the tool point at positions of the whole volume, without the mean offset, um.
struct ControllerErrors {
  std::array<double, 3> before_um{}, after_um{};  // largest of X, Y and Z
  /// Largest error along an axis that arrived in its positive or negative direction.
  std::array<double, 3> after_positive_um{}, after_negative_um{};
  double rms_before_um = 0, rms_after_um = 0;  // of the three directions together
  std::size_t positions = 0;
};

/// Evaluates the chain with the corrected commands at positions between the points (4096, fixed seed), each
/// axis in a random direction. tool.
ControllerErrors controller_errors(const model::Machine& machine, const PrinterAxes& axes,
                                   const ControllerTables& tables, const model::States& at);

}  // namespace vernier::exchange
