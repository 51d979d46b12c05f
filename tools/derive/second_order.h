// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "tools/derive/error_equation.h"
#include "tools/derive/interval.h"

namespace vernier::derive {

/// What the first order leaves out, over the declared ranges of axes and inputs and all errors up to their
/// magnitude.
struct SecondOrder {
  double position_mm = 0;  // norm of the tool point's deviation that is missing
  double axis_rad = 0;     // norm of the missing change of the tool's direction
};

/// A proved bound, or why there is none. Interval arithmetic, no samples: with every error scaled by s from 0
/// to 1, p(s) is a rigid chain whose motion j has speed at most D1 and acceleration at most D2, so that
///   |p''| <= sum_j D2_j L_j + sum_turns D1_j^2 L_j + 2 sum_{i<j, i turns} D1_i D1_j L_j,
/// L_j the largest distance of the tool point from turning axis j, 1 for a shift; half of that is the
/// remainder.
struct SecondOrderBound {
  std::optional<SecondOrder> bound;
  std::string reason;  // where there is no bound
};
SecondOrderBound bound_second_order(const ErrorEquation& equation);

/// The largest remainder seen in `count` random poses with all errors at plus or minus their magnitude: a
/// lower limit that shows how tight the bound is, no proof. Linear axes without a range: nothing. tool.
std::optional<SecondOrder> sample_second_order(const ErrorEquation& equation, std::size_t count,
                                               std::uint64_t seed);

/// Ranges of all nominal symbols: axes by min and max (tables' ends, a full turn for rotary axes, where
/// absent), statics at their nominal, inputs and motion as for compile. Linear axes without any are left out.
Ranges nominal_ranges(const ErrorEquation& equation);

}  // namespace vernier::derive
