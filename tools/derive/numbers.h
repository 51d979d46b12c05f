// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

namespace vernier::derive {

/// Returns the exact rational of the shortest decimal of `value` (0.1 is 1/10). Decimals of pi, 180/pi and
/// pi/180 with eleven digits or more become the exact constants.
GiNaC::ex exact_number(double value);

/// Returns radians of an angle in degrees, and the inverse; exact.
GiNaC::ex to_rad(const GiNaC::ex& angle_deg);
GiNaC::ex to_deg(const GiNaC::ex& angle_rad);

/// Returns the sine of an angle with quarter turns removed; cosine() does the same for cos. The first symbol
/// of the angle determines the sign of the result: sin(-C) is -sin(C), cos(B - pi/2) is sin(B). GiNaC does
/// not convert sine and cosine in this way.
GiNaC::ex sine(const GiNaC::ex& angle_rad);
GiNaC::ex cosine(const GiNaC::ex& angle_rad);

}  // namespace vernier::derive
