// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/create/dh_table.h"

namespace vernier::create {

/// An axis as its owner describes it: name, travel, and the direction along which it moves (X Y Z) or about
/// which it turns (A B C).
struct PlannedAxis {
  std::string name;
  double min = 0, max = 0;  // mm or deg
  char direction = 'X';
  bool rollover = false;           // turns without end; the range is one turn
  std::array<double, 3> centre{};  // of a rotary axis, at zero of all others: mm
  bool rotary() const { return direction >= 'A' && direction <= 'C'; }
  /// Returns 0, 1, 2 for the directions X, Y, Z and A, B, C.
  std::size_t along() const { return static_cast<std::size_t>(direction - (rotary() ? 'A' : 'X')); }
};

/// Contents of a new machine file. Both sides begin at the bed; the last entry of a side carries the tool or
/// the workpiece.
struct MachinePlan {
  std::string type, name;
  std::vector<PlannedAxis> axes;                  // as the file lists them
  std::vector<std::size_t> tool_side, work_side;  // indices of axes
  std::array<double, 3> tool{};                   // its point in the frame of the last axis of its side, mm
  std::vector<DhRow> arm;                         // of a robot, a row a joint; else empty
  std::array<double, 6> base{};                   // BaseShift: chain base in the measuring frame, mm, deg
  /// If true, only errors that an instrument along each axis measures are free in a fit: squareness,
  /// straightness and angles stay 0.
  bool positioning_only = false;
};

/// A type of machine for which `new` has a default chain.
struct MachineType {
  const char* name;
  const char* title;
  const char* tool_side;  // directions from the bed to the tool, "YXZ"; those the machine lacks are left out
  const char* work_side;
  std::array<const char*, 3> slides;  // what X, Y and Z are called
};

/// Returns the machine types of `vernier new`, including the robot.
const std::vector<MachineType>& machine_types();

/// "X:0:600", "U:0:300:X" (along X), "C:0:360:wrap". Throws InputError with the word.
PlannedAxis parse_planned_axis(const std::string& words);

/// Assigns the axes to the sides as the type defines them. tool_order, work_order: axis names from the bed
/// outwards, if the order differs from the type. Throws InputError: an unknown type (with the reason for a
/// delta), no axis, a name twice, an axis on no side.
MachinePlan plan_machine(const std::string& type, std::vector<PlannedAxis> axes,
                         const std::optional<std::vector<std::string>>& tool_order,
                         const std::optional<std::vector<std::string>>& work_order);

/// Returns the plan of a robot from its rows and the same number of axes. Empty axes: J1, J2 … of ±180 deg,
/// prismatic 0 to 500 mm. Throws InputError if the numbers of rows and axes differ.
MachinePlan plan_robot(std::vector<PlannedAxis> axes, const std::vector<DhRow>& rows);

/// Returns positions that divide a range at round numbers into four to seven parts: the stations of a table.
std::vector<double> round_stations(double min, double max, bool rotary);

}  // namespace vernier::create
