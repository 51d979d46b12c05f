// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>

#include "tools/exchange/controller/tables.h"

namespace vernier::exchange {

/// Kinds of tables that a controller supports, and their limits.
struct ControllerRules {
  std::size_t most_own = 2, most_cross = 0;  // points of a table; most_cross 0: no tables of other axes
  bool own_reverse = false;                  // own tables have values of their own in the negative direction
  bool same_points = false;                  // all tables of an input axis share their positions
  bool stairs = false;
  double value_step_mm = 1e-6;     // resolution of the values
  double position_step_mm = 1e-6;  // resolution of the positions
};

/// Data of the user about the tables.
struct ControllerWishes {
  double tolerance_um = 1;            // error between the points at which the number of points is enough
  double step_mm = 0;                 // distance of the points; 0: chosen by the tolerance
  std::array<double, 3> reference{};  // position at which the tables are zero, mm
};

/// Returns the tables that hold the corrections of a machine as sums of functions of one axis: the mean of
/// the corrections over positions of the other axes. Values and positions are rounded as the files have
/// them. Without step_mm, the number of points grows until the error between them is within the tolerance or
/// the controller's limit is reached. In the second case the function uses the number of points with the
/// smallest error. Tables of other axes below a quarter of the tolerance are left out. `at` (count 1): inputs
/// and motion. Throws InputError: step_mm needs more points than the controller keeps.
ControllerTables controller_tables(const model::Machine& machine, const ThreeAxes& axes,
                                   const ControllerRules& rules, const model::States& at,
                                   const ControllerWishes& wishes);

}  // namespace vernier::exchange
