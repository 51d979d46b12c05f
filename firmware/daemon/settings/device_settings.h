// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "firmware/daemon/settings/board_file.h"
#include "hal/support/analogue_scale.h"
#include "hal/support/wrapped_count.h"

namespace vernier {

/// The setting polarity: "normal", which is the default, or "inverted". Throws BoardError.
/// Not real-time safe.
bool is_inverted(const SignalSource& source);

/// Reads the settings span, zero, low, high and polarity of an analogue output. Each name has the `suffix`
/// ("_ns") if it counts codes. codes: number of codes of the whole span. rotary: span is in degrees, else in
/// mm. Throws BoardError. Not real-time safe.
AnalogueScale analogue_scale(const SignalSource& source, bool rotary, std::int64_t codes, const char* suffix);

/// Reads the settings resolution, range and polarity of an output that is a signed number: correction /
/// resolution. The scale's codes are shifted by its zero. Throws BoardError. Not real-time safe.
AnalogueScale number_scale(const SignalSource& source, bool rotary);

/// Reads the settings scale (um of a count; 0.001 deg of a rotary axis; below 0: the other way) and offset
/// (mm or deg at the device's zero) of a position. Throws BoardError. Not real-time safe.
PositionScale position_scale(const SignalSource& source, bool rotary);

}  // namespace vernier
