// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "tools/derive/error_equation.h"
#include "tools/derive/symbol_ranges.h"

namespace vernier::derive {

/// Remainder of the first-order equation over the declared ranges of axes and inputs, with all errors up to
/// their magnitude.
struct SecondOrder {
  double position_mm = 0;  // norm of the remainder of the tool point's deviation
  double axis_rad = 0;     // norm of the remainder of the tool direction's change
};

/// A proved bound of the remainder, or the reason why no bound exists. The bound of the remainder is
/// computed with interval arithmetic and not from samples. Every error is multiplied by a factor s from 0 to
/// 1, and p(s) is the tool point of the chain with these errors. In the chain, D1_j and D2_j are bounds of
/// the first and the second derivative of the shift or turn j with respect to s. From this follows |p''| <=
/// sum_j D2_j L_j + sum_turns D1_j^2 L_j + 2 sum_{i<j, i turns} D1_i D1_j L_j. In this formula, L_j is the
/// largest distance of the tool point from the rotary axis j; L_j is 1 for a shift. The remainder of the
/// first order is at most half of |p''|.
struct SecondOrderBound {
  std::optional<SecondOrder> bound;
  std::string reason;  // reason why no bound exists
};
SecondOrderBound bound_second_order(const ErrorEquation& equation);

/// Returns the largest remainder in `count` random poses, with each error at plus or minus its magnitude. The
/// result of sample_second_order() is a lower limit of the true maximum and not a proof. The sampled
/// remainder shows how close the proved bound is. The function sample_second_order() returns nullopt if a
/// linear axis has no range.
std::optional<SecondOrder> sample_second_order(const ErrorEquation& equation, std::size_t count,
                                               std::uint64_t seed);

/// Returns the ranges of all nominal symbols. Axes have their min and max (if absent, the ends of the tables,
/// or a full turn for rotary axes). Statics have their nominal values; inputs and motion have the ranges of
/// compile. Linear axes without a range are not in the result.
Ranges nominal_ranges(const ErrorEquation& equation);

}  // namespace vernier::derive
