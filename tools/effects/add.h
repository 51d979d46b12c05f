// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/effects/candidate.h"

namespace vernier::effects {

/// Returns the text of the machine file with the candidate's terms, statics (nominal 0) and inputs added. The
/// rest of the text does not change. Throws InputError.
std::string add_to_machine_text(const std::string& text, const model::Machine& machine,
                                const Candidate& candidate);

}  // namespace vernier::effects
