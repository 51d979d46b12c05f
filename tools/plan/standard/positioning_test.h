// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::plan {

/// Request for a test of positioning of one axis with a laser or a dial gauge. Lengths in mm, angles in deg.
struct PositioningTestOptions {
  std::string axis;
  std::optional<double> from, to;     // first and last target; default: the axis's range without the overrun
  std::optional<double> overrun;      // travel beyond the end targets; default: a hundredth of the range
  std::optional<double> period;       // of a possible periodic error (pitch of the screw)
  std::size_t targets = 0, runs = 0;  // 0: as many as the standard requires
  std::string at;                     // positions of the other axes: "Y=200,Z=-75"; default: mid-range
  double feed = 5000;                 // mm/min or deg/min
  double dwell_s = 5;                 // at each target; 0: the program stops until a person starts it again
};

/// A test of positioning. Source: ISO 230-2:2014, 4.3 (targets) and figure 1 (test cycle).
struct PositioningTest {
  std::size_t axis = 0;  // of the machine
  bool rotary = false;
  std::vector<double> targets;  // ascending
  std::size_t runs = 5;         // each: all targets forward, then all backward
  double interval = 0;          // nominal, of the targets
  double overrun = 0, feed = 0, dwell_s = 0;
  std::vector<double> rest;  // positions of all axes; that of the tested axis has no meaning
  std::string reading;       // column of the reading: the coordinate along (rotary: about) the axis
  double minutes = 0;        // estimate, without the time in stops
};

/// Chooses targets with unequal intervals: target i is at (i - 1) times the interval plus a random number of
/// at most one period, or of 30 % of the interval if no period is given. Equal requests give equal targets.
/// At most 2000 mm: at least five targets, five in each metre, and five runs; longer axes: an interval of at
/// most 250 mm and one run; rotary axes: three targets up to 90 deg, five up to 180, eight beyond. Throws
/// InputError: unknown axis, no range, targets outside the range, too few targets or runs for an evaluation.
PositioningTest positioning_test(const model::Machine& machine, const PositioningTestOptions& options);

/// Describes the test and the next command for a person.
std::string positioning_test_text(const model::Machine& machine, const PositioningTest& test);
/// Returns a measurement file with a row for each reading, in the order of the program. The readings must be
/// filled in.
std::string positioning_test_csv(const model::Machine& machine, const PositioningTest& test);
/// Returns the program of the test as G-code: mm or deg, mm/min or deg/min, dwell in seconds.
std::string positioning_test_gcode(const model::Machine& machine, const PositioningTest& test);

}  // namespace vernier::plan
