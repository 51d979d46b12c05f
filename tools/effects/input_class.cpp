// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/input_class.h"

#include <cctype>
#include <string>

#include "tools/maths/factors.h"
#include "tools/vibration/signal_features.h"

namespace vernier {

InputClass class_of_input(const Input& input) {
  const std::string& unit = input.unit;
  if (unit == "degC" || unit == "K") return InputClass::kTemperature;
  if (unit == "N" || unit == "kg") return InputClass::kLoad;
  if (unit == "mm/s^2" || unit == "m/s^2" || unit == "deg/s^2" || unit == "g") return InputClass::kFeature;
  if (!unit.empty() && unit != "V" && unit != "mV") return InputClass::kOther;
  std::string lower;
  for (const char c : input.name) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto has = [&](const char* part) { return lower.find(part) != std::string::npos; };
  if (has("temp") || input.name.rfind("T_", 0) == 0) return InputClass::kTemperature;
  if (has("load") || has("force") || has("mass") || has("torque") || has("weight")) return InputClass::kLoad;
  if (has("vib") || has("acc") || has("rms")) return InputClass::kFeature;
  for (const char* feature : kFeatureNames)
    if (input.name.ends_with(std::string("_") + feature)) return InputClass::kFeature;
  return InputClass::kOther;
}

double standard_reference(std::string_view unit) {
  constexpr double kZeroCelsius_K = 273.15;
  return unit == "K" ? kZeroCelsius_K + kReferenceDegC : kReferenceDegC;
}

}  // namespace vernier
