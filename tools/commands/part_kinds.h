// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>

namespace vernier::part_cli {

/// Adds `vernier part conformity`. tool.
void add_conformity(CLI::App& part);

}  // namespace vernier::part_cli
