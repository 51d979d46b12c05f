// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "hal/clock.h"

namespace vernier {

class AxisReader;
class CanAxes;
class IioBuffer;

/// Longest time for which a trial waits for a device.
inline constexpr TimeUs kPatience(1'000'000);

// Each function of this file tests an open device. Each test returns an empty text if the device works, or
// the error. For the set-up of a board only.

/// Waits for one frame of an axis on the bus, and returns a description of the frame.
std::string hear_axis(Clock& clock, CanAxes& bus, std::uint32_t axis);
/// Waits for one reading of an axis. Returns false if the axis gave no reading.
bool hear_position(Clock& clock, AxisReader& axes, std::uint32_t axis);
/// Waits for one scan of a sensor, and returns a description of the scan.
std::string hear_scan(Clock& clock, IioBuffer& buffer, std::uint32_t channel);

}  // namespace vernier
