// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/format/units.h"

#include <array>
#include <utility>

#include "tools/maths/factors.h"

namespace vernier::format {
namespace {

/// Standard gravity, mm/s^2 (ISO 80000-3).
constexpr double kStandardGravity = 9806.65;

constexpr std::array<Unit, 48> kUnits = {{
    {"", Dimension::kNone, 1, 0},
    {"mm", Dimension::kLength, 1, 0},
    {"um", Dimension::kLength, 1e-3, 0},
    {"m", Dimension::kLength, 1e3, 0},
    {"in", Dimension::kLength, 25.4, 0},
    {"thou", Dimension::kLength, 0.0254, 0},
    {"uin", Dimension::kLength, 25.4e-6, 0},
    {"nm", Dimension::kLength, 1e-6, 0},
    {"cm", Dimension::kLength, 10, 0},
    {"0.1um", Dimension::kLength, 1e-4, 0},
    {"0.1mm", Dimension::kLength, 0.1, 0},
    {"0.01mm", Dimension::kLength, 0.01, 0},  // a division of a dial gauge
    {"0.0001in", Dimension::kLength, 0.00254, 0},
    {"deg", Dimension::kAngle, 1, 0},
    {"0.01deg", Dimension::kAngle, 0.01, 0},
    {"0.001deg", Dimension::kAngle, 0.001, 0},
    {"rad", Dimension::kAngle, maths::kDegPerRad, 0},
    {"mrad", Dimension::kAngle, maths::kDegPerRad / 1000, 0},
    {"urad", Dimension::kAngle, maths::kDegPerRad / 1e6, 0},
    {"arcmin", Dimension::kAngle, 1.0 / 60, 0},
    {"arcsec", Dimension::kAngle, 1.0 / 3600, 0},
    {"degC", Dimension::kTemperature, 1, 0},
    {"K", Dimension::kTemperature, 1, -273.15},
    {"degF", Dimension::kTemperature, 5.0 / 9, -160.0 / 9},
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
    {"rpm", Dimension::kAngularSpeed, 6, 0},
    {"A", Dimension::kCurrent, 1, 0},
    {"Hz", Dimension::kFrequency, 1, 0},
    {"Pa", Dimension::kPressure, 1, 0},
    {"bar", Dimension::kPressure, 1e5, 0},
    {"Nm", Dimension::kTorque, 1, 0},
    {"W", Dimension::kPower, 1, 0},
    {"um/m", Dimension::kRatio, 1, 0},
    {"%", Dimension::kRatio, 1e4, 0},
}};
constexpr Unit kPerMm = {"1/mm", Dimension::kCurvature, 1, 0};

/// Signs in UTF-8 and their text in the formats; a longer sign before a sign that begins it.
constexpr std::array<std::pair<std::string_view, std::string_view>, 15> kSigns = {{
    {"\u00b5", "u"},      // micro sign
    {"\u03bc", "u"},      // Greek small mu
    {"\u00b0C", "degC"},  // degree sign
    {"\u00ba"
     "C",
     "degC"},            // masculine ordinal, which many keyboards give instead
    {"\u2103", "degC"},  // degree Celsius in one sign
    {"\u00b0F", "degF"},
    {"\u00ba"
     "F",
     "degF"},
    {"\u2109", "degF"},  // degree Fahrenheit in one sign
    {"\u00b0", "deg"},
    {"\u00ba", "deg"},
    {"\u2033", "arcsec"},  // double prime
    {"\u00b2", "^2"},
    {"\u00b7", ""},  // middle dot: N·m
    {"\u22c5", ""},  // dot operator
    {"\u00a0", ""},  // no-break space
}};

}  // namespace

std::string usual_spelling(std::string_view unit) {
  std::string text;
  while (!unit.empty()) {
    std::size_t taken = 1;
    std::string_view written = unit.substr(0, 1);
    for (const auto& [sign, meaning] : kSigns)
      if (unit.starts_with(sign)) {
        taken = sign.size();
        written = meaning;
        break;
      }
    text += written;
    unit.remove_prefix(taken);
  }
  return text;
}

std::string canonical_unit(std::string_view unit) {
  const auto found = find_unit(unit);
  return found ? found->name : std::string(unit);
}

std::optional<Unit> find_unit(std::string_view name) {
  const std::string spelled = usual_spelling(name);
  for (const Unit& unit : kUnits)
    if (spelled == unit.name) return unit;
  if (spelled == kPerMm.name) return kPerMm;
  return std::nullopt;
}

std::string known_units() {
  std::string text;
  for (const Unit& unit : kUnits)
    if (*unit.name != '\0') text += std::string(unit.name) + " ";
  return text + kPerMm.name;
}

std::vector<Dimension> all_dimensions() {
  std::vector<Dimension> list;
  for (int k = 0; k <= static_cast<int>(Dimension::kRatio); ++k) list.push_back(static_cast<Dimension>(k));
  return list;
}

std::vector<std::string> units_of(Dimension dimension) {
  std::vector<std::string> names;
  for (const Unit& unit : kUnits)
    if (unit.dimension == dimension && *unit.name != '\0') names.emplace_back(unit.name);
  if (dimension == kPerMm.dimension) names.emplace_back(kPerMm.name);
  return names;
}

const char* base_unit(Dimension dimension) {
  for (const Unit& unit : kUnits)
    if (unit.dimension == dimension && unit.factor == 1 && unit.offset == 0) return unit.name;
  return kPerMm.name;
}

}  // namespace vernier::format
