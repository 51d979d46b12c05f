// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

namespace vernier::derive {

/// Returns the exact rational number for the shortest decimal text of `value` (0.1 becomes 1/10). Decimal
/// numbers for pi, 180/pi and pi/180 with eleven digits or more become the exact constants.
GiNaC::ex exact_number(double value);

/// to_rad converts an angle from degrees to radians, and to_deg from radians to degrees. Both conversions,
/// to_rad and to_deg, are exact.
GiNaC::ex to_rad(const GiNaC::ex& angle_deg);
GiNaC::ex to_deg(const GiNaC::ex& angle_rad);

/// sine() returns the sine of an angle, simplified for quarter turns; cosine() does the same for the cosine.
/// The first symbol of the angle gets a positive sign: sin(-C) becomes -sin(C), and cos(B - pi/2) becomes
/// sin(B). The library GiNaC does not simplify sine and cosine of quarter turns.
GiNaC::ex sine(const GiNaC::ex& angle_rad);
GiNaC::ex cosine(const GiNaC::ex& angle_rad);

}  // namespace vernier::derive
