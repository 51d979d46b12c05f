// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

namespace vernier::registry {

/// True for a name that a machine may have: letters, digits, `.`, `_` and `-`, the first a letter or a digit,
/// 1 to 200 bytes. Such a name is safe in a file name, a topic, a list of lines and a shell.
bool is_machine_name(std::string_view name);
/// Throws InputError for another name.
void require_machine_name(const std::string& name);
/// `text` with each {machine} replaced by the name.
std::string for_machine(std::string text, const std::string& machine);

}  // namespace vernier::registry
