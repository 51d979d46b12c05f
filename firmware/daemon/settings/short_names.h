// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "firmware/daemon/settings/signal_source.h"

namespace vernier {

/// An output of kind "modbus" becomes one of kind "modbus-out": the registers `sequence`, `valid` and
/// `register` (of the value) become first register and place of a block, `scale` (um or 0.001 deg of a count)
/// becomes `resolution`. Other kinds stay. A missing `range` of "modbus" or "canopen" becomes max_correction
/// (mm or deg). Throws BoardError with the line of the setting. Not real-time safe.
void use_short_names(SignalSource& output, double max_correction);

}  // namespace vernier
