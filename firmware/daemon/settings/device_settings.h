// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "firmware/daemon/settings/board_file.h"
#include "hal/support/analogue_scale.h"

namespace vernier {

/// The setting polarity: "normal", which is the default, or "inverted". Throws BoardError. setup.
bool is_inverted(const SignalSource& source);

/// The settings span, zero, low, high and polarity of an analogue output, each name with `suffix` ("_ns") if
/// it counts codes. codes: those of the whole span. rotary: span is in degrees, else in mm. Throws
/// BoardError. setup.
AnalogueScale analogue_scale(const SignalSource& source, bool rotary, std::int64_t codes, const char* suffix);

}  // namespace vernier
