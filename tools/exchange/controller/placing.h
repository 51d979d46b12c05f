// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>

#include "tools/exchange/controller/tables.h"

namespace vernier::exchange {

/// Kinds of compensation tables that a controller supports, and their limits.
struct ControllerRules {
  std::size_t most_own = 2, most_cross = 0;  // largest number of points in a table; most_cross 0: the
                                             // controller has no tables for other axes
  bool own_reverse = false;                  // true: the table of an axis for itself can have separate values
                                             // for the negative direction
  bool same_points = false;                  // true: all tables with the same input axis have the same
                                             // positions
  bool stairs = false;
  double value_step_mm = 1e-6;     // resolution of the values in a table
  double position_step_mm = 1e-6;  // resolution of the positions in a table
};

/// Requirements of the user for the tables.
struct ControllerWishes {
  double tolerance_um = 1;            // largest permitted error between the points of a table
  double step_mm = 0;                 // distance between the points; 0: determined by the tolerance
  std::array<double, 3> reference{};  // reference position at which the tables are zero, mm
};

/// Returns compensation tables, which represent the corrections of a machine as sums of functions of one
/// axis. A table is the mean of the corrections over positions of the other axes. The values and positions
/// are rounded as in the files of the controller. If step_mm is 0, the number of points is increased until
/// the error between the points is within the tolerance, or the controller's limit is reached. If the limit
/// is reached, the number of points with the smallest error is used. Tables for other axes are omitted if
/// their values are below a quarter of the tolerance. A table for another axis whose shape beside its
/// straight line is less than twice its standard uncertainty by the last fit (rms over the travel) has the
/// straight line only (`uncertain`): as in the safety sheet, such a correction may increase the error. `at`
/// (one state): values of inputs and motion. Throws InputError if step_mm needs more points than the
/// controller permits.
ControllerTables controller_tables(const model::Machine& machine, const ThreeAxes& axes,
                                   const ControllerRules& rules, const model::States& at,
                                   const ControllerWishes& wishes);

}  // namespace vernier::exchange
