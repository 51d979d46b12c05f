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

/// A unit that measurement files may write. value in base unit = factor * value + offset; base units are mm,
/// deg, degC, s, mm/s, deg/s, mm/s^2, deg/s^2, V, N, kg, 1/mm, A, Hz, Pa, Nm, W, um/m.
struct Unit {
  const char* name;
  Dimension dimension;
  double factor, offset;
};

/// The unit of that name (case-sensitive), also with usual signs (µ, °, ²: `usual_spelling`); `nullopt` for
/// an unknown one. "" is the pure number.
std::optional<Unit> find_unit(std::string_view name);

/// The text with signs of the keyboard: µ (both of Unicode's) as u, °C as degC, ° as deg, ″ as arcsec, ² as
/// ^2, a middle dot left out. tool.
std::string usual_spelling(std::string_view unit);

/// The name that find_unit has for it; the text itself if find_unit does not know it. tool.
std::string canonical_unit(std::string_view unit);

/// All names, for messages.
std::string known_units();

/// All dimensions in the order of Dimension; the names of the units of one of them.
std::vector<Dimension> all_dimensions();
std::vector<std::string> units_of(Dimension dimension);

/// The base unit of a dimension as written.
const char* base_unit(Dimension dimension);

}  // namespace vernier::format
