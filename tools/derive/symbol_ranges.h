// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

#include <map>
#include <stdexcept>

#include "tools/compile/symbolic/interval.h"

namespace vernier::derive {

/// Ranges of the symbols in an expression.
using Ranges = std::map<GiNaC::ex, compile::Interval, GiNaC::ex_is_less>;

/// Exception: an expression has no finite range, because a symbol has no range or because of a division by a
/// range that contains zero.
class NoRange : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns an interval that contains every value of an expression over the ranges of its symbols. Every
/// operation extends its result by 1e-12 of the result, which is far above the rounding error of a double.
/// Throws NoRange if the expression has no range.
compile::Interval range_of(const GiNaC::ex& expr, const Ranges& ranges);

/// Returns the range of the sine (sine_range) or cosine (cosine_range) over an interval of angles in rad.
compile::Interval sine_range(const compile::Interval& angle_rad);
compile::Interval cosine_range(const compile::Interval& angle_rad);

}  // namespace vernier::derive
