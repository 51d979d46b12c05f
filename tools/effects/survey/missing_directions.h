// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::effects {

/// Returns one note for each measurement file that has no approach direction of a moving axis, although
/// another file of the survey has it. The model then predicts no reversal error in this file, and the file
/// contradicts a reversal error that the other files show.
std::vector<std::string> notes_of_missing_directions(const model::Machine& machine,
                                                     const model::Measurement& rows);

}  // namespace vernier::effects
