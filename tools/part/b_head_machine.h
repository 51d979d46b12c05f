// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"
#include "tools/part/joint_path.h"

namespace vernier::part {

/// A machine file whose nominal chain is that of the five-axis machine with B head and C table. The machine
/// may have any errors that the file format can represent; its free statics are the parameters of the part.
struct BHeadMachine {
  model::Machine machine;
  double pivot_mm = 0;                // B axis to tool tip, read off the nominal chain
  std::array<std::size_t, 5> axis{};  // indices of X Y Z B C among the machine's axes

  /// Returns the joint values of the origin of the work coordinates: tip at (0, 0, 0), tool vertical, C = 0.
  JointPose origin() const { return {0, 0, pivot_mm, 0, 0}; }
  /// Returns rows for the chain; inputs are at their reference, motion is zero.
  model::States states(const std::vector<JointPose>& joints) const;
};

/// Checks the nominal chain against the closed forward kinematics at poses over the ranges of the axes.
/// Throws InputError if an axis is missing or the chain is another.
BHeadMachine b_head_machine(model::Machine machine);

/// Returns tables/machines/five_axis_bhead_ctable.xml as it was when the program was built: the machine of
/// the paper with its eight location errors, all 0; angles in deg, L0 499.889 mm (the paper's simulation).
std::string default_b_head_text();

/// Names of the eight location errors, in the order of the paper.
inline constexpr std::array<const char*, 8> kLocationErrors = {"EC0Y", "EA0Z", "EB0Z", "EA0C",
                                                               "EB0C", "EX0B", "EA0B", "EC0B"};

/// Sets statics from "EA0B=3.2419e-4rad, EX0B=0.0294": comma or blank between; a number with a unit is
/// converted to the unit of the static; a number without a unit is in the unit of the static. Throws
/// InputError for an unknown or hidden name, a malformed number or a unit of another dimension.
void set_errors(model::Machine& machine, const std::string& text);

}  // namespace vernier::part
