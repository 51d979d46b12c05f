// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::format {

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
  kCurrent,
  kFrequency,
  kPressure,
  kTorque,
  kPower,
  kRatio,
};

/// A unit that measurement files may use. value in base unit = factor * value + offset; base units are mm,
/// deg, degC, s, mm/s, deg/s, mm/s^2, deg/s^2, V, N, kg, 1/mm, A, Hz, Pa, Nm, W, um/m.
struct Unit {
  const char* name;
  Dimension dimension;
  double factor, offset;
};

/// Finds a unit by its name (case-sensitive), also with usual signs (µ, °, ²: `usual_spelling`); `nullopt`
/// for an unknown name. "" is the pure number.
std::optional<Unit> find_unit(std::string_view name);

/// Replaces special signs by signs of the keyboard: µ (both of Unicode's) by u, °C by degC, ° by deg, ″ by
/// arcsec, ² by ^2; a middle dot is removed.
std::string usual_spelling(std::string_view unit);

/// Returns the name of a unit as in find_unit; the unchanged text if find_unit has no such unit.
std::string canonical_unit(std::string_view unit);

/// Returns the names of all units, for messages.
std::string known_units();

/// all_dimensions: all dimensions in the order of Dimension. units_of: the names of the units of one
/// dimension.
std::vector<Dimension> all_dimensions();
std::vector<std::string> units_of(Dimension dimension);

/// The base unit of a dimension as written.
const char* base_unit(Dimension dimension);

}  // namespace vernier::format
