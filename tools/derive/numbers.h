// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

namespace vernier::derive {

/// The exact rational that the shortest decimal of `value` names (0.1 is 1/10); the decimals of pi, 180/pi
/// and pi/180 to eleven digits or more become those constants. tool.
GiNaC::ex exact_number(double value);

/// Radians of an angle in degrees, and back; exact.
GiNaC::ex to_rad(const GiNaC::ex& angle_deg);
GiNaC::ex to_deg(const GiNaC::ex& angle_rad);

/// sin and cos with quarter turns taken out and the sign of the angle settled by its first symbol: sin(-C) is
/// -sin(C), cos(B - pi/2) is sin(B). GiNaC leaves these as they are.
GiNaC::ex sine(const GiNaC::ex& angle_rad);
GiNaC::ex cosine(const GiNaC::ex& angle_rad);

}  // namespace vernier::derive
