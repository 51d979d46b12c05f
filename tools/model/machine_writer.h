// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/model/machine.h"

namespace vernier::model {

/// Writes the machine into the text from which the machine was read. Values of statics, tables and BaseShift
/// change. The rest of the text (comments, order, unknown spelling) does not change. Throws InputError.
/// `set_nominal`: a static without `nominal` gets the value that it had in the text.
std::string update_machine_text(const std::string& text, const Machine& machine, bool set_nominal);

}  // namespace vernier::model
