// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string_view>

#include "tools/model/machine.h"

namespace vernier::effects {

/// Class of a logged column: as the machine file states, else by its unit (by its name if it has no unit).
/// kSetpoint: a value that a controller requested, not a reading. A set-point adds no information to the
/// reading of the same quantity.
enum class InputClass : std::uint8_t { kTemperature, kLoad, kFeature, kSetpoint, kOther };
InputClass class_of_input(const model::Input& input);

/// Returns the value at which the terms of an input are 0, if the machine file states no reference. The
/// reference is the standard temperature, or the mean of the readings to two digits.
double usual_reference(const model::Input& input, double mean);

/// Returns the temperature at which dimensions are specified (ISO 1), in a unit of temperature: 20
/// degC or 293.15 K.
double standard_reference(std::string_view unit);

}  // namespace vernier::effects
