// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace vernier::commands {

/// Returns the manual page (troff, man macros) of a command. The content comes from the definitions for
/// --help. `names`: the words of the command, "vernier fit". `version`: "vernier 1.2.0".
std::string manual_page(const CLI::App& command, const std::string& names, const std::string& version);

}  // namespace vernier::commands
