// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/import/columns/column_map.h"
#include "tools/model/machine.h"

namespace vernier::commands::import_cli {

/// Output files and options of every kind of import.
struct ImportOutput {
  std::string csv_path, json_path;
};

/// Adds the options `-o FILE` (required) and `--json FILE` to a kind of import.
void add_import_output(CLI::App& kind, ImportOutput& output);

/// Returns the call of a kind of import as the user wrote it, with quotes for a shell: "vernier import table
/// laser.xlsx --sheet "Achse Y"". `without`: options that are left out, for example "--json".
std::string call_of(const CLI::App& kind, const std::vector<std::string>& without);

/// Throws InputError if a table has no column for an axis of the machine. The message has the call of the
/// user with the option that adds a constant position. `hint`: text before this call. `columns`: words of the
/// option --column that the call has instead.
void require_axes(const importer::ImportTable& table, const model::Machine& machine, const CLI::App& kind,
                  const std::string& hint, const std::vector<std::string>& columns = {});

// Each kind of import (instrument file format) has one function of this type. The function of a kind of
// import adds the options and the callback to the subcommand.
#define X(id, name, reads, ending) void add_##id##_kind(CLI::App& kind);
#include "tools/import/kinds.inc"
#undef X

}  // namespace vernier::commands::import_cli
