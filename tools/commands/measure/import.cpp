// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/command.h"
#include "tools/commands/measure/import_kinds.h"

namespace vernier::commands::import_cli {
namespace {

using AddKind = void (*)(CLI::App& import);
constexpr AddKind kKinds[] = {add_table_kind,   add_ballbar_kind, add_ballbar_trace_kind,
                              add_tracker_kind, add_probe_kind,   add_laser_kind};

}  // namespace

void add_import_output(CLI::App& kind, ImportOutput& output) {
  kind.add_option("-o,--output", output.csv_path, "Measurement file to write (CSV)")
      ->type_name(kWrites)
      ->required();
  kind.add_option("--json", output.json_path, "Result for programs; - is standard output")
      ->type_name(kWrites);
}

void register_import(CLI::App& vernier) {
  CLI::App* import =
      vernier.add_subcommand("import", "Convert the file of an instrument to a measurement file (CSV)");
  import->require_subcommand(1);
  for (const AddKind add : kKinds) add(*import);
}

}  // namespace vernier::commands::import_cli
