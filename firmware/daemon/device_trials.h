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

// Each function tries an open device: empty, or the error. setup.

/// Waits for one frame of an axis and describes it.
std::string hear_axis(Clock& clock, CanAxes& bus, std::uint32_t axis);
/// Waits for one reading of any axis; false: no reading came.
bool hear_position(Clock& clock, AxisReader& axes, std::uint32_t axis);
/// Waits for one scan of a sensor and describes it.
std::string hear_scan(Clock& clock, IioBuffer& buffer, std::uint32_t channel);

}  // namespace vernier
