// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>

namespace vernier::commands::evaluate_cli {

/// Adds the command `evaluate iso230-6`.
void add_diagonals_kind(CLI::App& evaluate);
/// Adds the command `evaluate iso9283`.
void add_robot_kind(CLI::App& evaluate);

}  // namespace vernier::commands::evaluate_cli
