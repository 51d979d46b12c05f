// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "firmware/daemon/settings/signal_source.h"

namespace vernier {

/// Converts an output of kind "modbus" to an output of kind "modbus-out". The settings `sequence`, `valid`
/// and `register` (of the value) become first register and positions in a block; `scale` (um or 0.001 deg per
/// count) becomes `resolution`. Outputs of other kinds are not changed. If the setting `range` of "modbus" or
/// "canopen" is missing, it gets the value max_correction (mm or deg). If a setting is wrong, throws
/// BoardError with its line. Not real-time safe.
void use_short_names(SignalSource& output, double max_correction);

}  // namespace vernier
