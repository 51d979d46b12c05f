// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::plan {

/// Request for a positioning test of one axis with a laser interferometer or a dial gauge. In a positioning
/// test, lengths are in mm and angles in deg.
struct PositioningTestOptions {
  std::string axis;
  std::optional<double> from, to;     // first and last target; default: the range of the axis without the
                                      // overrun
  std::optional<double> overrun;      // travel beyond the end targets; default: one hundredth of the range
  std::optional<double> period;       // period of a possible periodic error (pitch of the screw)
  std::size_t targets = 0, runs = 0;  // number of targets and runs; 0: the number that the standard requires
  std::string at;                     // positions of the other axes: "Y=200,Z=-75"; default: middle of the
                                      // range
  double feed = 5000;                 // mm/min or deg/min
  double dwell_s = 5;                 // dwell at each target; 0: the program stops until a person starts it
                                      // again
};

/// A positioning test of one axis with its targets and runs. The targets are those of ISO 230-2:2014, 4.3;
/// the test cycle is that of figure 1.
struct PositioningTest {
  std::size_t axis = 0;  // index of the tested axis in the machine
  bool rotary = false;
  std::vector<double> targets;  // target positions, ascending
  std::size_t runs = 5;         // in each run, all targets are approached forward and then backward
  double interval = 0;          // nominal interval between the targets
  double overrun = 0, feed = 0, dwell_s = 0;
  std::vector<double> rest;  // positions of all axes during the test; the entry of the tested axis has no
                             // meaning
  std::string reading;       // name of the reading's column: the coordinate along the axis, or about it for a
                             // rotary axis
  double minutes = 0;        // estimated duration, without the time of stops
};

/// Selects targets with unequal intervals. Target i is at (i - 1) times the interval plus a random number.
/// The random number is at most one period, or 30 % of the interval if no period is given. Equal requests
/// for a positioning test give equal random numbers. Numbers of targets and runs by the standard: for axes
/// up to 2000 mm at least five targets, five in each metre, and five runs; for longer axes an interval of at
/// most 250 mm and one run; for rotary axes three targets up to 90 deg, five up to 180 deg, eight above.
/// Throws InputError for: an unknown axis, an axis without range, targets outside the range, too few targets
/// or runs for an evaluation.
PositioningTest positioning_test(const model::Machine& machine, const PositioningTestOptions& options);

/// Returns a text for users that describes the test and the command to use next.
std::string positioning_test_text(const model::Machine& machine, const PositioningTest& test);
/// Returns a measurement file with one row for each reading, in the order of the G-code program. The user
/// must enter the readings in this file.
std::string positioning_test_csv(const model::Machine& machine, const PositioningTest& test);
/// Returns the program of the test as G-code. Units are mm or deg, mm/min or deg/min, and s for the dwell.
std::string positioning_test_gcode(const model::Machine& machine, const PositioningTest& test);

}  // namespace vernier::plan
