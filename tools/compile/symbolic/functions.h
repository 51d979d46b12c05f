// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

#include "tools/compile/symbolic/interval.h"

namespace vernier::compile {

enum class Function : std::uint8_t { kSin, kCos, kExp, kLog, kSqrt, kReciprocal, kArcTangent };

/// Returns the value of a function; slope_of returns its first derivative. Arguments of sine and cosine and
/// results of the arc tangent are in degrees.
double value_of(Function f, double x);
double slope_of(Function f, double x);
/// Returns the largest |first| and |fourth| derivative over an interval (closed form). The fourth bounds the
/// error of cubic pieces.
double slope_bound(Function f, const Interval& x);
double fourth_derivative_bound(Function f, const Interval& x);
const char* name_of(Function f);
/// Returns the range of a function over an interval of its domain.
Interval range_of_function(Function f, const Interval& x);

}  // namespace vernier::compile
