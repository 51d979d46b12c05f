// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/input_class.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "tools/format/units.h"
#include "tools/maths/factors.h"
#include "tools/maths/rounding.h"
#include "tools/text/words.h"
#include "tools/vibration/signal_features.h"

namespace vernier::effects {

namespace {

constexpr std::array<std::string_view, 8> kSetpoints = {"target", "set",     "setpoint", "sp",
                                                        "cmd",    "command", "demand",   "goal"};

/// Does a name end like the name of a set-point: T_bed_target, nozzle_set?
bool is_setpoint(const std::string& name) {
  const auto last = name.find_last_of("_-. ");
  if (last == std::string::npos) return false;
  const std::string end = name.substr(last + 1);
  // T_sp is more often the temperature of a spindle; T_bed_sp is a set-point.
  if (end == "sp" && name.find_first_of("_-. ") == last) return false;
  return std::find(kSetpoints.begin(), kSetpoints.end(), end) != kSetpoints.end();
}

}  // namespace

InputClass class_of_input(const model::Input& input) {
  switch (input.role) {
    case model::InputRole::kTemperature:
      return InputClass::kTemperature;
    case model::InputRole::kLoad:
      return InputClass::kLoad;
    case model::InputRole::kVibration:
      return InputClass::kFeature;
    case model::InputRole::kSetpoint:
      return InputClass::kSetpoint;
    case model::InputRole::kOther:
      return InputClass::kOther;
    case model::InputRole::kGuessed:
      break;
  }
  const std::string& unit = input.unit;
  const std::string lower = text::in_small_letters(input.name);
  if (is_setpoint(lower)) return InputClass::kSetpoint;
  if (const auto known = format::find_unit(unit);
      known && known->dimension == format::Dimension::kTemperature)
    return InputClass::kTemperature;
  if (unit == "N" || unit == "kg") return InputClass::kLoad;
  if (unit == "mm/s^2" || unit == "m/s^2" || unit == "deg/s^2" || unit == "g") return InputClass::kFeature;
  if (!unit.empty() && unit != "V" && unit != "mV") return InputClass::kOther;
  const auto has = [&](const char* part) { return lower.find(part) != std::string::npos; };
  if (has("temp") || input.name.rfind("T_", 0) == 0) return InputClass::kTemperature;
  if (has("load") || has("force") || has("mass") || has("torque") || has("weight")) return InputClass::kLoad;
  if (has("vib") || has("acc") || has("rms")) return InputClass::kFeature;
  for (const char* feature : vibration::kFeatureNames)
    if (input.name.ends_with(std::string("_") + feature)) return InputClass::kFeature;
  return InputClass::kOther;
}

double usual_reference(const model::Input& input, double mean) {
  if (class_of_input(input) == InputClass::kTemperature) return standard_reference(input.unit);
  if (std::abs(mean) < 1e-9) return 0;
  return maths::to_two_digits(mean);
}

double standard_reference(std::string_view unit) {
  const auto known = format::find_unit(unit);
  if (!known || known->dimension != format::Dimension::kTemperature) return maths::kReferenceDegC;
  return std::round(1e6 * (maths::kReferenceDegC - known->offset) / known->factor) / 1e6;
}

}  // namespace vernier::effects
