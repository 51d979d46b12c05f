// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <numbers>

/// Factors between the units in the output of the tools. All factors between units are defined only here.
/// Files use the units mm, deg, degC and s. Radians occur only inside functions that need radians.
namespace vernier::maths {

inline constexpr double kRadPerDeg = std::numbers::pi / 180;
inline constexpr double kDegPerRad = 180 / std::numbers::pi;
inline constexpr double kUmPerMm = 1e3;
inline constexpr double kArcsecPerDeg = 3600;
inline constexpr double kUradPerDeg = kRadPerDeg * 1e6;
inline constexpr double kSecondsPerMinute = 60;
inline constexpr double kMmPerInch = 25.4;  // exact, by the definition of the inch
/// Temperature at which dimensions are specified (ISO 1).
inline constexpr double kReferenceDegC = 20;

}  // namespace vernier::maths
