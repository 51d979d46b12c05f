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

/// A label for each moment (row or tick). Moments without labels have the label of their run.
struct Labels {
  std::vector<std::size_t> of;     // for each moment: index into names; empty if the labels of the runs are
                                   // used
  std::vector<std::string> names;  // names of the labels, each name once
};

/// All quantities on which an expression may depend, for N moments (rows of a measurement or ticks of a
/// path), stored column by column. All columns have N entries. The order of the axes is that of
/// Machine::axes; the order of the inputs is that of Machine::inputs.
struct States {
  std::size_t count = 0;
  std::vector<Column> axis;          // position without scale factor, mm or deg
  std::vector<Column> velocity;      // mm/s, deg/s
  std::vector<Column> acceleration;  // mm/s^2, deg/s^2
  std::vector<Column> direction;     // -1, 0, +1
  std::vector<Column> since;         // travel since the last reversal, mm or deg; kLongWay if not known
  Column feed;                       // feed, mm/min
  Column curvature;                  // curvature of the path, 1/mm
  std::array<Column, 3> normal;      // unit vector of the row's normal; 0 if the row has no normal
  Column time;                       // time, s
  Column visit;                      // number of rows since the start of the clock
  std::vector<Column> input;
  std::vector<std::size_t> run;  // for each moment: index into run_names
  std::vector<std::string> run_names;
  Labels setup;  // labels of the set-ups; the rows of one set-up have the same BaseShift
  Labels clock;  // labels of continuous times: a lag, a count of visits and a drift start again at each clock
  Labels block;  // labels of the parts that may be held out to test the rest

  std::size_t of(const Labels& labels, std::size_t moment) const {
    return labels.of.empty() ? run[moment] : labels.of[moment];
  }
  const std::vector<std::string>& names(const Labels& labels) const {
    return labels.of.empty() ? run_names : labels.names;
  }
};

/// The members of States with labels for set-ups, clocks and blocks.
inline constexpr std::array<Labels States::*, 3> kStateLabels = {&States::setup, &States::clock,
                                                                 &States::block};

/// Assigns all moments to one run with the name `name`, one set-up, one clock and one block.
void make_one_run(States& states, const std::string& name);
/// Begins a new run with the name `name` at a moment. At the moment at which a new run begins, a new set-up,
/// clock and block begin too.
void begin_run(States& states, std::size_t moment, const std::string& name);
/// Appends the runs, set-ups, clocks and blocks of `next`. Labels with the same name are merged. `apart`:
/// true keeps the labels of `next` separate from the labels of `all`, also if they have the same name.
/// append_labels() does not change the columns.
void append_labels(States& all, const States& next, bool apart = false);

/// Value of `since` if the travel since the last reversal is not recorded. The value of `since` for an
/// unknown travel is larger than any decay length.
inline constexpr double kLongWay = 1e9;

/// Returns `count` states for a machine with `axes` axes and these inputs. All columns are zero, `since` is
/// kLongWay, and there is one run with an empty name.
States make_states(std::size_t count, std::size_t axes, const std::vector<double>& input_references);

/// Returns `count` states for the axes and inputs of a machine. Each input has its reference value.
States make_states(std::size_t count, const Machine& machine);

/// Returns the states with the indices `which`, in the order of `which`.
States select_states(const States& states, const std::vector<std::size_t>& which);

}  // namespace vernier::model
