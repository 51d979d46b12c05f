// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string_view>

#include "tools/model/machine.h"

namespace vernier::effects {

/// Class of a logged column: the class in the machine file, otherwise the class of its unit, or of its name
/// if the column has no unit. kSetpoint: a value that a controller requested, not a reading. A set-point
/// gives no information in addition to the reading of the same quantity.
enum class InputClass : std::uint8_t { kTemperature, kLoad, kFeature, kSetpoint, kOther };
InputClass class_of_input(const model::Input& input);

/// Returns the value at which the terms of an input are 0, if the machine file states no reference. The
/// reference value of an input is the standard temperature, or for other inputs the mean of the readings to
/// two digits.
double usual_reference(const model::Input& input, double mean);

/// Returns the temperature at which dimensions are specified (ISO 1), in a unit of temperature: 20
/// degC or 293.15 K.
double standard_reference(std::string_view unit);

}  // namespace vernier::effects
