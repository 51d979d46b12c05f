// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/effects/candidate.h"

namespace vernier::effects {

/// The machine file with the candidate's terms, statics (nominal 0) and inputs written into it; nothing else
/// changes. Throws InputError. tool.
std::string add_to_machine_text(const std::string& text, const model::Machine& machine,
                                const Candidate& candidate);

}  // namespace vernier::effects
