// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/effects/candidate.h"

namespace vernier::effects {

/// Returns the text of the machine file to which the terms, statics (nominal 0) and inputs of a candidate
/// effect are added. The rest of the machine file does not change. Throws InputError if the candidate cannot
/// be added to the machine file.
std::string add_to_machine_text(const std::string& text, const model::Machine& machine,
                                const Candidate& candidate);

}  // namespace vernier::effects
