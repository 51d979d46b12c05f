// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace vernier::commands::import_cli {

/// Output files and options that every kind of import has.
struct ImportOutput {
  std::string csv_path, json_path;
};

/// Adds `-o FILE` (required) and `--json FILE` to a kind. tool.
void add_import_output(CLI::App& kind, ImportOutput& output);

// One function a kind: adds its subcommand, options and callback to `vernier import`; listed in
// import_command.cpp.
void add_table_kind(CLI::App& import);
void add_ballbar_kind(CLI::App& import);
void add_ballbar_trace_kind(CLI::App& import);
void add_tracker_kind(CLI::App& import);
void add_probe_kind(CLI::App& import);
void add_laser_kind(CLI::App& import);

}  // namespace vernier::commands::import_cli
