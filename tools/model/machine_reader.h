// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/model/machine.h"

namespace vernier::model {

/// Reads a machine file. Throws InputError with file, line and word.
Machine read_machine(const std::string& path);
/// Reads a machine from the text of a machine file. `file` is only used in messages.
Machine parse_machine(const std::string& text, const std::string& file);

}  // namespace vernier::model
