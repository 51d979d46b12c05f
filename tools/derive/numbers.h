// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

namespace vernier::derive {

/// Returns the exact rational of the shortest decimal of `value` (0.1 is 1/10). Decimals of pi,
/// 180/pi and pi/180 with eleven digits or more become those constants. tool.
GiNaC::ex exact_number(double value);

/// Returns radians of an angle in degrees, and the inverse; exact.
GiNaC::ex to_rad(const GiNaC::ex& angle_deg);
GiNaC::ex to_deg(const GiNaC::ex& angle_rad);

/// sin and cos with quarter turns removed. The first symbol of the angle determines its sign:
/// sin(-C) is -sin(C), cos(B - pi/2) is sin(B). GiNaC does not convert these.
GiNaC::ex sine(const GiNaC::ex& angle_rad);
GiNaC::ex cosine(const GiNaC::ex& angle_rad);

}  // namespace vernier::derive
