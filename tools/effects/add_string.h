// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/effects/candidate.h"

namespace vernier::effects {

/// Converts a choice to its `add` string (FORMATS section 3), and back. If the string names no transform or
/// form, the transform of the axis and the first form that fits are used. Throws InputError with the
/// offending word.
std::string add_string(const model::Machine& machine, const Choice& choice);
Choice parse_add_string(const std::string& text, const model::Machine& machine,
                        const std::vector<Effect>& effects);

}  // namespace vernier::effects
