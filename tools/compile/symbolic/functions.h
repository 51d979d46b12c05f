// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

#include "tools/compile/symbolic/interval.h"

namespace vernier::compile {

enum class Function : std::uint8_t { kSin, kCos, kExp, kLog, kSqrt, kReciprocal, kArcTangent };

/// value_of returns the value of a function, and slope_of returns its first derivative. The arguments of sine
/// and cosine, and the result of the arc tangent, are in degrees.
double value_of(Function f, double x);
double slope_of(Function f, double x);
/// Returns the largest magnitude over an interval (closed form): of the first derivative (slope_bound), and
/// of the fourth derivative (fourth_derivative_bound). The fourth derivative bounds the error of cubic
/// polynomials.
double slope_bound(Function f, const Interval& x);
double fourth_derivative_bound(Function f, const Interval& x);
const char* name_of(Function f);
/// Returns the range of a function over an interval of its domain.
Interval range_of_function(Function f, const Interval& x);

}  // namespace vernier::compile
