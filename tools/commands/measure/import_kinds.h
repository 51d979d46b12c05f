// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace vernier::commands::import_cli {

/// Output files and options of every kind of import.
struct ImportOutput {
  std::string csv_path, json_path;
};

/// Adds the options `-o FILE` (required) and `--json FILE` to a kind of import.
void add_import_output(CLI::App& kind, ImportOutput& output);

// Each kind of import (instrument file format) has one function of this type. The function of a kind of
// import adds the options and the callback to the subcommand.
#define X(id, name, reads, ending) void add_##id##_kind(CLI::App& kind);
#include "tools/import/kinds.inc"
#undef X

}  // namespace vernier::commands::import_cli
