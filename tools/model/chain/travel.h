// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>

#include "tools/model/machine.h"

namespace vernier::model {

/// A position may be outside the travel by this share of the travel: overrun of a control.
inline constexpr double kTravelSlack = 0.01;

/// Returns the number of positions (mm or deg) outside the travel min to max of an axis; 0 if the machine
/// file states no travel. `first`: if not null, gets the index of the first of these positions.
std::size_t rows_outside_travel(const Axis& axis, const Eigen::Ref<const Eigen::ArrayXd>& positions,
                                std::size_t* first = nullptr);

}  // namespace vernier::model
