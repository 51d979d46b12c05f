// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/model/machine.h"

namespace vernier::model {

/// Returns the text of a machine file with the values of `machine`. `text` is the text from which the machine
/// was read. The values of statics, tables and BaseShifts and the travels of axes change in the text. The
/// rest of the text (comments, order, unknown elements) does not change. Throws InputError if `text` is not a
/// valid machine file. `set_nominal`: if true, a static without `nominal` gets the attribute `nominal` with
/// the value that the static had in the text.
std::string update_machine_text(const std::string& text, const Machine& machine, bool set_nominal);

}  // namespace vernier::model
