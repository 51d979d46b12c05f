// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/text/units.h"

#include <array>

#include "tools/maths/factors.h"

namespace vernier {
namespace {

/// Standard gravity, mm/s^2 (ISO 80000-3).
constexpr double kStandardGravity = 9806.65;

constexpr std::array<Unit, 25> kUnits = {{
    {"", Dimension::kNone, 1, 0},
    {"mm", Dimension::kLength, 1, 0},
    {"um", Dimension::kLength, 1e-3, 0},
    {"m", Dimension::kLength, 1e3, 0},
    {"in", Dimension::kLength, 25.4, 0},
    {"deg", Dimension::kAngle, 1, 0},
    {"rad", Dimension::kAngle, kDegPerRad, 0},
    {"arcsec", Dimension::kAngle, 1.0 / 3600, 0},
    {"degC", Dimension::kTemperature, 1, 0},
    {"K", Dimension::kTemperature, 1, -273.15},
    {"s", Dimension::kTime, 1, 0},
    {"ms", Dimension::kTime, 1e-3, 0},
    {"min", Dimension::kTime, 60, 0},
    {"mm/s", Dimension::kSpeed, 1, 0},
    {"mm/min", Dimension::kSpeed, 1.0 / 60, 0},
    {"m/s", Dimension::kSpeed, 1e3, 0},
    {"deg/s", Dimension::kAngularSpeed, 1, 0},
    {"mm/s^2", Dimension::kAcceleration, 1, 0},
    {"m/s^2", Dimension::kAcceleration, 1e3, 0},
    {"g", Dimension::kAcceleration, kStandardGravity, 0},
    {"deg/s^2", Dimension::kAngularAcceleration, 1, 0},
    {"V", Dimension::kVoltage, 1, 0},
    {"mV", Dimension::kVoltage, 1e-3, 0},
    {"N", Dimension::kForce, 1, 0},
    {"kg", Dimension::kMass, 1, 0},
}};
constexpr Unit kPerMm = {"1/mm", Dimension::kCurvature, 1, 0};

}  // namespace

std::optional<Unit> find_unit(std::string_view name) {
  for (const Unit& unit : kUnits)
    if (name == unit.name) return unit;
  if (name == kPerMm.name) return kPerMm;
  return std::nullopt;
}

std::string known_units() {
  std::string text;
  for (const Unit& unit : kUnits)
    if (*unit.name != '\0') text += std::string(unit.name) + " ";
  return text + kPerMm.name;
}

const char* base_unit(Dimension dimension) {
  for (const Unit& unit : kUnits)
    if (unit.dimension == dimension && unit.factor == 1 && unit.offset == 0) return unit.name;
  return kPerMm.name;
}

}  // namespace vernier
