// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string_view>

#include "tools/model/machine.h"

namespace vernier::effects {

/// What a logged column is: what the machine file says, else by its unit (by its name where it has none).
/// kSetpoint: what a controller asked for, no reading: it explains nothing that the reading beside it does
/// not.
enum class InputClass : std::uint8_t { kTemperature, kLoad, kFeature, kSetpoint, kOther };
InputClass class_of_input(const model::Input& input);

/// Where the terms of an input are 0, unless the machine file says it: the standard temperature, or the mean
/// of what was read, to two digits. tool.
double usual_reference(const model::Input& input, double mean);

/// The temperature at which dimensions are specified (ISO 1), in a unit of temperature: 20 degC or 293.15 K.
/// tool.
double standard_reference(std::string_view unit);

}  // namespace vernier::effects
