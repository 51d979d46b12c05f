// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/effects/candidate.h"

namespace vernier::effects {

/// The `add` string of a choice, and back (FORMATS section 3). What the string leaves open is filled with the
/// axis' own transform and the form's first fit. Throws InputError with the offending word. tool.
std::string add_string(const model::Machine& machine, const Choice& choice);
Choice parse_add_string(const std::string& text, const model::Machine& machine,
                        const std::vector<Effect>& effects);

}  // namespace vernier::effects
