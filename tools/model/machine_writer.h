// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/model/machine.h"

namespace vernier::model {

/// Writes the machine back into the text it was read from: values of statics, tables and BaseShift changed,
/// everything else (comments, order, unknown spelling) as the user wrote it. Throws InputError. tool.
/// `set_nominal`: a static without `nominal` gets the value that it had in the text.
std::string update_machine_text(const std::string& text, const Machine& machine, bool set_nominal);

}  // namespace vernier::model
