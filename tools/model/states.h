// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace vernier {

using Column = Eigen::ArrayXd;

/// Everything an expression may depend on, for N moments (rows of a measurement or ticks of a path), column
/// by column. All columns have N entries; axis-wise vectors are indexed like Machine::axes, inputs like
/// Machine::inputs.
struct States {
  std::size_t count = 0;
  std::vector<Column> axis;          // raw position, mm or deg
  std::vector<Column> velocity;      // mm/s, deg/s
  std::vector<Column> acceleration;  // mm/s^2, deg/s^2
  std::vector<Column> direction;     // -1, 0, +1
  std::vector<Column> since;         // mm, deg; kLongWay where not recorded
  Column feed;                       // mm/min
  Column curvature;                  // 1/mm
  std::array<Column, 3> normal;      // unit vector of the row, 0 where it has none
  Column time;                       // s
  Column visit;                      // rows since the start of the run
  std::vector<Column> input;
  std::vector<std::size_t> run;  // index into run_names
  std::vector<std::string> run_names;
};

/// `since` where no column says it: far beyond any decay length.
inline constexpr double kLongWay = 1e9;

/// States of `count` moments for a machine with these numbers of axes and inputs: all columns zero, `since`
/// kLongWay, one run named "".
States make_states(std::size_t count, std::size_t axes, const std::vector<double>& input_references);

/// The rows `which` of `states`, in that order.
States select_states(const States& states, const std::vector<std::size_t>& which);

}  // namespace vernier
