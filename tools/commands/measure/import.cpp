// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/command.h"
#include "tools/commands/measure/import_kinds.h"
#include "tools/import/kinds.h"

namespace vernier::commands::import_cli {
namespace {

using AddKind = void (*)(CLI::App& kind);
constexpr AddKind kKinds[] = {
#define X(id, name, reads, ending) add_##id##_kind,
#include "tools/import/kinds.inc"
#undef X
};

}  // namespace

void add_import_output(CLI::App& kind, ImportOutput& output) {
  kind.add_option("-o,--output", output.csv_path, "Measurement file to write (CSV)")
      ->type_name(kWrites)
      ->required();
  kind.add_option("--json", output.json_path,
                  "File for the result as JSON, for programs; - for standard output")
      ->type_name(kWrites);
}

void register_import(CLI::App& vernier) {
  CLI::App* import =
      vernier.add_subcommand("import", "Convert the file of an instrument to a measurement file (CSV)");
  import->require_subcommand(1);
  const auto kinds = importer::import_kinds();
  for (std::size_t i = 0; i < kinds.size(); ++i)
    kKinds[i](*import->add_subcommand(kinds[i].name, kinds[i].reads));
}

}  // namespace vernier::commands::import_cli
