// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "tools/registry/registry.h"

namespace vernier::commands::fleet_cli {

/// Adds the option `--registry`; its default is the variable VERNIER_REGISTRY.
void add_registry(CLI::App& command, std::string& place);
/// Opens the registry with the given name; creates a file that does not exist. Throws InputError if no name
/// is given, or if the registry is not available.
registry::Registry make_registry(const std::string& place);
/// Opens a registry that exists already; a misspelt file name is refused.
registry::Registry open_registry(const std::string& place);

/// Converts a time that a user wrote to us since 1970; `otherwise` if the text is empty. Throws InputError if
/// the text is not a time.
std::int64_t time_of(const std::string& text, std::int64_t otherwise);

/// Writes one complete line to standard error; any thread may call this function.
void say_line(const std::string& line);

/// The subcommands of `vernier fleet`; each subcommand has one source file.
void add_services(CLI::App& fleet);
void add_batch(CLI::App& fleet);
void add_trends(CLI::App& fleet);
void add_rollout(CLI::App& fleet);

}  // namespace vernier::commands::fleet_cli
