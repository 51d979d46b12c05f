// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/model/machine.h"

namespace vernier::model {

/// Reads a machine file. If the file is not valid, read_machine throws InputError with file, line and word.
Machine read_machine(const std::string& path);
/// Reads a machine from the text of a machine file. `file`: name of the file in messages.
Machine parse_machine(const std::string& text, const std::string& file);

}  // namespace vernier::model
