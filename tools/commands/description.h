// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vernier::commands {

/// Returns the words that an option accepts on the command line; empty if any text is accepted.
std::vector<std::string> allowed_words(const CLI::Option& option);

/// Returns every command and kind of command with its options, from the declarations of the command line:
/// [{"name": "import table", "help", "options": [{"name": "check-every", "typed": "--check-every" or "-o",
/// empty for an argument without an option, "kind", "list", "required", "help"; where they exist "words",
/// "low", "high", "default"}]}]. An argument that the help shows as MEAS has the name "meas". kind: "flag",
/// "text", "number", "count" (0, 1, 2 …), "reads" (a file that the command reads), "reads-folder",
/// "reads-or-server" (a file that the command reads, or the address of a database server), "writes" (a file
/// that the command writes) or "writes-folder".
nlohmann::ordered_json describe(const CLI::App& vernier);

}  // namespace vernier::commands
