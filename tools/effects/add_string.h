// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/effects/candidate.h"

namespace vernier::effects {

/// Converts a choice to its `add` string and back (FORMATS section 3). Where the string gives no
/// transform or form, the axis' own transform and the first form that fits are used. Throws
/// InputError with the offending word. tool.
std::string add_string(const model::Machine& machine, const Choice& choice);
Choice parse_add_string(const std::string& text, const model::Machine& machine,
                        const std::vector<Effect>& effects);

}  // namespace vernier::effects
