// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"
#include "tools/part/joint_path.h"

namespace vernier::part {

/// A machine file whose nominal chain is that of a five-axis machine with B head and C table. The machine may
/// have any errors that the file format can represent. The free statics of the machine are the parameters of
/// the part test.
struct BHeadMachine {
  model::Machine machine;
  double pivot_mm = 0;                // distance from the B axis to the tool tip, from the nominal chain
  std::array<std::size_t, 5> axis{};  // indices of the axes X Y Z B C in the machine

  /// Returns the joint values at the origin of the work coordinates: tool tip at (0, 0, 0), tool vertical, C
  /// = 0.
  JointPose origin() const { return {0, 0, pivot_mm, 0, 0}; }
  /// Returns states for the chain at these joint values. The inputs have their reference values, and all
  /// speeds are zero.
  model::States states(const std::vector<JointPose>& joints) const;
};

/// Compares the nominal chain with the closed-form forward kinematics at poses over the ranges of the axes.
/// Throws InputError if an axis is missing or if the chain is that of another machine.
BHeadMachine b_head_machine(model::Machine machine);

/// Returns the text of tables/machines/five_axis_bhead_ctable.xml at the time when the program was built. The
/// text describes the machine of the paper with its eight location errors, all 0. Angles are in deg, and L0
/// is 499.889 mm (the paper's simulation).
std::string default_b_head_text();

/// Names of the eight location errors of the machine, in the order of the paper.
inline constexpr std::array<const char*, 8> kLocationErrors = {"EC0Y", "EA0Z", "EB0Z", "EA0C",
                                                               "EB0C", "EX0B", "EA0B", "EC0B"};

/// Sets statics from a text such as "EA0B=3.2419e-4rad, EX0B=0.0294", with commas or blanks as separators. A
/// number with a unit is converted to the unit of the static; a number without a unit is in the unit of the
/// static. Throws InputError for an unknown or hidden name, a number that is not valid, or a unit of another
/// dimension.
void set_errors(model::Machine& machine, const std::string& text);

}  // namespace vernier::part
