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

/// A unit that measurement files may use. The value in the base unit is factor * value + offset. Base units
/// are mm, deg, degC, s, mm/s, deg/s, mm/s^2, deg/s^2, V, N, kg, 1/mm, A, Hz, Pa, Nm, W, um/m.
struct Unit {
  const char* name;
  Dimension dimension;
  double factor, offset;
};

/// Returns the unit with the given name (case-sensitive), also with usual signs (µ, °, ²: `usual_spelling`);
/// nullopt if the name is unknown. The name "" is that of a number without unit.
std::optional<Unit> find_unit(std::string_view name);

/// Replaces special signs in the name of a unit by signs of the keyboard: µ (both Unicode characters) by u,
/// °C by degC, ° by deg, ″ by arcsec, ² by ^2. A middle dot is removed.
std::string usual_spelling(std::string_view unit);

/// Returns the name of a unit in the form of find_unit. If the unit is unknown, returns the unchanged text.
std::string canonical_unit(std::string_view unit);

/// Returns the names of all units, for messages.
std::string known_units();

/// all_dimensions returns all dimensions in the order of Dimension. units_of returns the names of the units
/// of one dimension.
std::vector<Dimension> all_dimensions();
std::vector<std::string> units_of(Dimension dimension);

/// Returns the name of the base unit of a dimension.
const char* base_unit(Dimension dimension);

}  // namespace vernier::format
