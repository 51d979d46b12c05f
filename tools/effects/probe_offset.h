// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/model/file_set_ups.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::effects {

/// Declares the columns probeX and probeY of a measurement in the machine file. probeX and probeY are the
/// position of the probe in the frame of the tool, minus the position of the tool point, mm. The function
/// adds the two inputs (reference 0: the tool point), and a transform by probeX and probeY after the last
/// transform of the tool branch. If rows with and without the probe touch objects, the unknown height of the
/// probe is added as the static `probe_height`. If the measurement has no such columns, or the machine file
/// declares probeX or probeY, the text does not change. `text`: the text from which `machine` was read. The
/// caller must read machine and rows again.
model::CompletedText with_probe_offset(const std::string& text, const model::Machine& machine,
                                       const model::Measurement& rows);

}  // namespace vernier::effects
