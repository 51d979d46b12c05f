// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/kinematics/correction.h"

namespace vernier::exchange {

/// An error of the machine that an exchange format cannot represent, and the size of the error.
struct LeftOut {
  std::string what;
  double um = 0;
  bool other_axis = false;  // depends on the position or direction of another axis
};

/// Limit above which an error counts, um: a tenth of the finest digit in the tables of controllers.
inline constexpr double kNothing_um = 0.01;

/// Finds the variables, other than the position and direction of `axis`, on which the first-order offset of
/// `axis` depends. The result has one entry for each significant variable (other axes, inputs, speed, travel
/// since reversal …): the largest change at random states (fixed seed) within the axis ranges. `at`: the
/// fixed state (count 1).
std::vector<LeftOut> beyond_own_axis(const model::Machine& machine, std::size_t axis,
                                     const model::States& at);

/// Deviations that stay when all tables are zero (position errors, scale factors, user terms): the largest at
/// random states.
std::vector<LeftOut> beyond_tables(const model::Machine& machine, const model::States& at);

/// Throws with all reasons, unless `allowed` is true. Throws InputError.
void refuse(const model::Machine& machine, const std::string& format, const std::vector<LeftOut>& left_out,
            bool allowed);

}  // namespace vernier::exchange
