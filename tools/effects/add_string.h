// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/effects/candidate.h"

namespace vernier::effects {

/// Convert a choice (an effect with its location and inputs) to its `add` string (FORMATS section 3), and an
/// `add` string to a choice. If the `add` string names no transform or no form, parse_add_string uses the
/// transform of the axis and the first form that fits. For a text that is not valid, throws InputError with
/// the wrong word.
std::string add_string(const model::Machine& machine, const Choice& choice);
Choice parse_add_string(const std::string& text, const model::Machine& machine,
                        const std::vector<Effect>& effects);

}  // namespace vernier::effects
