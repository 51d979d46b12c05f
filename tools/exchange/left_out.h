// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/kinematics/correction.h"

namespace vernier::exchange {

/// An error that a format cannot represent, and its size.
struct LeftOut {
  std::string what;
  double um = 0;
};

/// Above this an error counts as one, um: a tenth of the finest digit that controllers' tables are kept in.
inline constexpr double kNothing_um = 0.01;

/// Finds the variables, other than its position and direction, on which the first-order offset of `axis`
/// depends. Reports the largest change that other axes, inputs, speed, travel since reversal … make at random
/// states (fixed seed) within the axis ranges, one entry for each that is significant. `at`: the fixed state
/// (count 1). tool.
std::vector<LeftOut> beyond_own_axis(const model::Machine& machine, std::size_t axis,
                                     const model::States& at);

/// Deviations that stay when all tables are zero (position errors, scale factors, user terms): the largest at
/// random states. tool.
std::vector<LeftOut> beyond_tables(const model::Machine& machine, const model::States& at);

/// Refuses with all reasons unless `allowed`. Throws InputError.
void refuse(const model::Machine& machine, const std::string& format, const std::vector<LeftOut>& left_out,
            bool allowed);

}  // namespace vernier::exchange
