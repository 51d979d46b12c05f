// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/import/columns/column_map.h"
#include "tools/import/logs/nominal_list.h"
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

/// Returns options with quotes for a shell: " --column "x[mm]=X ist" --column y=Y".
std::string options_of(const std::string& option, const std::vector<std::string>& words);

/// Returns the call of the user with more `options`, to paste: it ends with "-o" and the file of the call, or
/// NEW.csv. `without`: options that are left out beside --output and --json.
std::string call_with(const CLI::App& kind, std::vector<std::string> without, const std::string& options);

/// Option with the assignments of the columns of a list of nominal positions.
inline constexpr const char* kNominalColumn = "--nominal-column";

/// Adds the option --nominal-column, the assignments of the columns of a list of nominal positions.
void add_nominal_columns(CLI::App& kind, std::vector<std::string>& columns);

/// Reads the list of nominal positions of a call. Its refusals have the call with the missing assignments.
importer::NominalList nominal_list(const CLI::App& kind, const std::string& file,
                                   const std::vector<std::string>& columns);

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
