// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "firmware/daemon/settings/board_file.h"
#include "hal/support/analogue_scale.h"
#include "hal/support/wrapped_count.h"

namespace vernier {

/// Reads the setting polarity: returns true for "inverted", and false for "normal" (the default). Throws
/// BoardError for any other text. Not real-time safe.
bool is_inverted(const SignalSource& source);

/// Reads the settings span, zero, low, high and polarity of an analogue output. The name of each setting ends
/// with `suffix` ("_ns") if the setting counts codes. `codes`: number of codes of the whole span. `rotary`:
/// true if the span is in degrees; false if it is in mm. Throws BoardError if a setting is missing or wrong.
/// Not real-time safe.
AnalogueScale analogue_scale(const SignalSource& source, bool rotary, std::int64_t codes, const char* suffix);

/// Reads the settings resolution, range and polarity of an output whose value is a signed number: correction
/// / resolution. The codes of the returned scale are shifted by its zero. Throws BoardError if a setting is
/// missing or wrong. Not real-time safe.
AnalogueScale number_scale(const SignalSource& source, bool rotary);

/// Reads the settings scale and offset of a position. The scale is in um per count (rotary axis: 0.001 deg
/// per count), negative for the opposite direction; the offset is the position at the device's zero in mm or
/// deg. Throws BoardError if a setting is missing or wrong. Not real-time safe.
PositionScale position_scale(const SignalSource& source, bool rotary);

}  // namespace vernier
