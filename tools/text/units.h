// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace vernier {

enum class Dimension {
  kNone,
  kLength,
  kAngle,
  kTemperature,
  kTime,
  kSpeed,
  kAngularSpeed,
  kAcceleration,
  kAngularAcceleration,
  kVoltage,
  kForce,
  kMass,
  kCurvature,
};

/// A unit that measurement files may write. value in base unit = factor * value + offset; base units are mm,
/// deg, degC, s, mm/s, deg/s, mm/s^2, deg/s^2, V, N, kg, 1/mm.
struct Unit {
  const char* name;
  Dimension dimension;
  double factor, offset;
};

/// The unit of that name (case-sensitive); nothing for an unknown one. "" is the pure number.
std::optional<Unit> find_unit(std::string_view name);

/// All names, for messages.
std::string known_units();

/// The base unit of a dimension as written.
const char* base_unit(Dimension dimension);

}  // namespace vernier
