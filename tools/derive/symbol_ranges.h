// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

#include <map>
#include <stdexcept>

#include "tools/compile/symbolic/interval.h"

namespace vernier::derive {

/// Ranges of symbols.
using Ranges = std::map<GiNaC::ex, compile::Interval, GiNaC::ex_is_less>;

/// An expression has no finite range: a symbol without a range, or a division by a range that
/// contains zero.
class NoRange : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns an interval that contains every value of the expression over the ranges. Every operation widens
/// its result by 1e-12 of the result, far above the rounding of a double. Throws NoRange if the expression
/// has no range.
compile::Interval range_of(const GiNaC::ex& expr, const Ranges& ranges);

/// Returns the range of sin and cos over an interval of angles in rad.
compile::Interval sine_range(const compile::Interval& angle_rad);
compile::Interval cosine_range(const compile::Interval& angle_rad);

}  // namespace vernier::derive
