// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace vernier::importer {

/// An axis of the machine for which a table has no column of its name.
struct MissingAxis {
  std::string name;
  bool rotary = true;
};

/// Returns the names of axes in their order: "X,Y,Z".
std::string axis_names(const std::vector<MissingAxis>& axes);

/// A column of numbers whose heading names no known quantity. `unit`: empty if the heading states none.
/// `assumed`: then the unit that the values probably have; empty: deg for an angle, mm for a length.
struct FreeColumn {
  std::string heading, name, unit, assumed = {};
};

/// Columns that are, or may be, the positions of axes: pairs of an index of an axis and an index of a column.
struct JointColumns {
  struct Pair {
    std::size_t axis = 0, column = 0;
  };
  std::vector<Pair> pairs;  // in the order of the axes; empty: no assignment of all axes was found
  bool sure = false;        // true: the names or the numbers and the units agree; false: the order alone
  std::string why;          // "by their names", "by their numbers", "by their order"
};

/// Finds columns for the axes under the names that robots use (shoulder_pan_joint, J1, A1, q1, joint_1). A
/// result covers all axes:
/// - sure: each axis has exactly one column whose name is equal except for punctuation, capital letters and
///   the words joint, axis, position, pos and angle; or axes and one family of columns have the same numbers
///   (J1 to J6 and q1 to q6) and units of an angle (turning axes) or a length;
/// - not sure: the table has exactly as many columns with a possible unit as the machine has missing axes, or
///   exactly one numbered family has this size (actual_q_0 to actual_q_5): by their order.
JointColumns joint_columns(const std::vector<MissingAxis>& axes, const std::vector<FreeColumn>& columns);

/// Returns "A1 to A6" if names of columns are those of the joints of a robot: at least five of one name with
/// consecutive numbers from 0 or 1. Empty: there are none.
std::string joint_series(const std::vector<std::string>& names);

/// Returns the word of the option --column that assigns a column to an axis: "J1=q1 [deg]". If the heading
/// states no unit, the word has the unit that is assumed: "J1[deg]=q1".
std::string column_word(const MissingAxis& axis, const FreeColumn& column);

}  // namespace vernier::importer
