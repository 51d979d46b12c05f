// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace vernier::registry {

/// True if a machine may have this name: letters, digits, `.`, `_` and `-`, beginning with a letter or a
/// digit, 1 to 200 bytes. A machine name of this form is safe in a file name, an MQTT topic, a list of lines
/// and a shell command.
bool is_machine_name(std::string_view name);
/// Throws InputError if a machine may not have this name.
void require_machine_name(const std::string& name);
/// Returns `text` in which the name of the machine replaces each {machine}.
std::string for_machine(std::string text, const std::string& machine);

}  // namespace vernier::registry
