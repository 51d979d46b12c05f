// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace vernier::model {

struct Machine;

using Column = Eigen::ArrayXd;

/// A label of each moment. Without labels the label of the run is used.
struct Labels {
  std::vector<std::size_t> of;     // index into names, one per moment; empty: as the run
  std::vector<std::string> names;  // each once
};

/// Everything an expression may depend on, for N moments (rows of a measurement or ticks of a path), column
/// by column. All columns have N entries; axis-wise vectors are indexed like Machine::axes, inputs like
/// Machine::inputs.
struct States {
  std::size_t count = 0;
  std::vector<Column> axis;          // raw position, mm or deg
  std::vector<Column> velocity;      // mm/s, deg/s
  std::vector<Column> acceleration;  // mm/s^2, deg/s^2
  std::vector<Column> direction;     // -1, 0, +1
  std::vector<Column> since;         // mm, deg; kLongWay if not recorded
  Column feed;                       // mm/min
  Column curvature;                  // 1/mm
  std::array<Column, 3> normal;      // unit vector of the row, 0 where it has none
  Column time;                       // s
  Column visit;                      // rows since the start of the clock
  std::vector<Column> input;
  std::vector<std::size_t> run;  // index into run_names
  std::vector<std::string> run_names;
  Labels setup;  // set-up: the rows that share a BaseShift
  Labels clock;  // continuous time: a lag, a count of visits and a drift start at each
  Labels block;  // part that may be held out to test the rest

  std::size_t of(const Labels& labels, std::size_t moment) const {
    return labels.of.empty() ? run[moment] : labels.of[moment];
  }
  const std::vector<std::string>& names(const Labels& labels) const {
    return labels.of.empty() ? run_names : labels.names;
  }
};

/// The labels of moments that can define set-ups, clocks and blocks.
inline constexpr std::array<Labels States::*, 3> kStateLabels = {&States::setup, &States::clock,
                                                                 &States::block};

/// Makes all moments one run of this name, with one set-up, one clock and one block.
void make_one_run(States& states, const std::string& name);
/// Starts a new run of this name at a moment. All other labels also start again at this moment.
void begin_run(States& states, std::size_t moment, const std::string& name);
/// Appends the runs, set-ups, clocks and blocks of `next`. Labels with the same name are merged. If `apart`,
/// a label of `next` is never merged with a label of `all`. The columns are not changed.
void append_labels(States& all, const States& next, bool apart = false);

/// `since` without a recorded column: far beyond any decay length.
inline constexpr double kLongWay = 1e9;

/// Returns `count` states for a machine with these numbers of axes and inputs: all columns zero, `since`
/// kLongWay, one run named "".
States make_states(std::size_t count, std::size_t axes, const std::vector<double>& input_references);

/// Returns `count` states for the axes and inputs of a machine, with each input at its reference.
States make_states(std::size_t count, const Machine& machine);

/// Returns the rows `which` of `states`, in that order.
States select_states(const States& states, const std::vector<std::size_t>& which);

}  // namespace vernier::model
