// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/kinematics/correction.h"

namespace vernier::exchange {

/// An error of the machine that an exchange format cannot represent, and the size of this error.
struct LeftOut {
  std::string what;
  double um = 0;
  bool other_axis = false;  // true: the error depends on the position or direction of another axis
  bool of_input = false;    // true: the error depends on an input (a temperature)
  bool measured = true;     // false: no reading determines the error, and `um` is only a plausible size
};

/// Limit below which an error is negligible, um. The limit is a tenth of the finest digit in the tables of
/// controllers.
inline constexpr double kNothing_um = 0.01;

/// Finds the variables, other than the position and direction of `axis`, on which the first-order offset of
/// `axis` depends. The result of beyond_own_axis() has one entry for each significant variable (other axes,
/// inputs, speed, travel since reversal …). The size of an entry is the largest change of the offset at
/// random states (fixed seed) within the axis ranges. `at`: the fixed state (one state).
std::vector<LeftOut> beyond_own_axis(const model::Machine& machine, std::size_t axis,
                                     const model::States& at);

/// Finds the errors by kind that a format of straight axes (squareness and scale) cannot hold, of the
/// first-order offset of each axis: the reversal error, the part along its own axis that is no scale (lead
/// and cyclic errors), and the part along each other axis that is no squareness (straightness). The other
/// axes are in the middle of their ranges. `heights`: true if the format has a mesh of heights, so that Z
/// along X and Y is no part of the list. `lost_motion`: what the format holds of the reversal error, mm, an
/// entry for each axis of the machine; empty: nothing.
std::vector<LeftOut> beyond_straight_axes(const model::Machine& machine, const model::States& at,
                                          bool heights, const std::vector<double>& lost_motion = {});

/// Returns deviations that remain if all tables are zero (position errors, scale factors, terms of the user):
/// the largest value at random states.
std::vector<LeftOut> beyond_tables(const model::Machine& machine, const model::States& at);

/// Returns a sentence with a list of all errors that a format cannot express.
std::string left_out_in_words(const std::string& format, const std::vector<LeftOut>& left_out);

/// Throws InputError with a list of all errors in `left_out`, unless the list is empty or `allowed` is true.
void refuse(const model::Machine& machine, const std::string& format, const std::vector<LeftOut>& left_out,
            bool allowed);

}  // namespace vernier::exchange
