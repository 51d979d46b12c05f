// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "tools/registry/registry.h"

namespace vernier::commands::fleet_cli {

/// Adds the option `--registry` to a command. The default of the option `--registry` is the environment
/// variable VERNIER_REGISTRY.
void add_registry(CLI::App& command, std::string& place);
/// Opens the registry with the given name. If the name is a file that does not exist, the file is created.
/// Throws InputError if the name is empty or the registry is not available.
registry::Registry make_registry(const std::string& place);
/// Opens an existing registry. A wrong file name of a registry is therefore an error, and no new registry is
/// created.
registry::Registry open_registry(const std::string& place);

/// Converts a time that a user wrote to us since 1970. If the text is empty, returns `otherwise`. Throws
/// InputError if the text is not a time.
std::int64_t time_of(const std::string& text, std::int64_t otherwise);

/// Writes one complete line to standard error. Any thread may call this function.
void say_line(const std::string& line);

/// Functions that add the subcommands of `vernier fleet`. Each subcommand has its own source file.
void add_services(CLI::App& fleet);
void add_batch(CLI::App& fleet);
void add_trends(CLI::App& fleet);
void add_rollout(CLI::App& fleet);

}  // namespace vernier::commands::fleet_cli
