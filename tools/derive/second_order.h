// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "tools/derive/error_equation.h"
#include "tools/derive/symbol_ranges.h"

namespace vernier::derive {

/// Remainder of the first order over the declared ranges of axes and inputs, with all errors up to their
/// magnitude.
struct SecondOrder {
  double position_mm = 0;  // norm of the missing part of the tool point's deviation
  double axis_rad = 0;     // norm of the missing change of the tool's direction
};

/// A proved bound of the remainder, or the reason why there is no bound. The bound uses interval arithmetic,
/// no samples. Every error is scaled by s from 0 to 1. p(s) is then a rigid chain whose motion j has at most
/// speed D1 and acceleration D2. Therefore |p''| <= sum_j D2_j L_j + sum_turns D1_j^2 L_j + 2 sum_{i<j, i
/// turns} D1_i D1_j L_j. L_j is the largest distance of the tool point from rotary axis j, 1 for a shift. The
/// remainder is at most half of |p''|.
struct SecondOrderBound {
  std::optional<SecondOrder> bound;
  std::string reason;  // if there is no bound
};
SecondOrderBound bound_second_order(const ErrorEquation& equation);

/// Returns the largest remainder in `count` random poses with all errors at plus or minus their magnitude.
/// The result is a lower limit, which shows how tight the bound is; the result is no proof. nullopt if a
/// linear axis has no range.
std::optional<SecondOrder> sample_second_order(const ErrorEquation& equation, std::size_t count,
                                               std::uint64_t seed);

/// Returns ranges of all nominal symbols: axes by min and max (if absent: the ends of the tables, a full turn
/// for rotary axes), statics at their nominal, inputs and motion as for compile. Linear axes without a range
/// are omitted.
Ranges nominal_ranges(const ErrorEquation& equation);

}  // namespace vernier::derive
