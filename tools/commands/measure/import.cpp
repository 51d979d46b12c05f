// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "tools/commands/command.h"
#include "tools/commands/measure/import_kinds.h"
#include "tools/import/kinds.h"
#include "tools/model/measurement_names.h"
#include "tools/text/error.h"

namespace vernier::commands::import_cli {
namespace {

using AddKind = void (*)(CLI::App& kind);
constexpr AddKind kKinds[] = {
#define X(id, name, reads, ending) add_##id##_kind,
#include "tools/import/kinds.inc"
#undef X
};

/// A word with quotes for a shell, if it needs them.
std::string in_quotes(const std::string& word) {
  if (!word.empty() && word.find_first_of(" \t'\"$&;*?()[]<>|`\\#!~") == std::string::npos) return word;
  if (word.find_first_of("\"$`\\!") == std::string::npos) return "\"" + word + "\"";
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::string call_of(const CLI::App& kind, const std::vector<std::string>& without) {
  std::string call = "vernier import " + kind.get_name(), options;
  for (const CLI::Option* const option : kind.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = "--" + (option->get_lnames().empty() ? "" : option->get_lnames().front());
    if (std::find(without.begin(), without.end(), name) != without.end()) continue;
    const bool flag = option->get_expected_max() == 0;
    if (flag) options += " " + name;
    for (const std::string& value : option->results()) {
      if (flag) continue;
      if (option->get_positional())
        call += " " + in_quotes(value);
      else
        options += " " + name + (value.starts_with("-") ? "=" : " ") + in_quotes(value);
    }
  }
  return call + options;
}

std::string options_of(const std::string& option, const std::vector<std::string>& words) {
  std::string options;
  for (const std::string& word : words) options += " " + option + " " + in_quotes(word);
  return options;
}

std::string call_with(const CLI::App& kind, std::vector<std::string> without, const std::string& options) {
  without.insert(without.end(), {"--output", "--json"});
  const CLI::Option* const output = kind.get_option_no_throw("--output");
  const bool named = output != nullptr && output->count() > 0;
  return call_of(kind, without) + options + " -o " +
         (named ? in_quotes(output->results().front()) : "NEW.csv");
}

void add_nominal_columns(CLI::App& kind, std::vector<std::string>& columns) {
  kind.add_option(
          kNominalColumn, columns,
          "--nominal: meaning of a column of the list, \"J1[deg]=A1\" (heading or number; -A1+90: the "
          "control counts it in the other direction and from another zero), as --column of import table; "
          "repeat the option for each column")
      ->needs("--nominal")
      ->allow_extra_args(false);
}

importer::NominalList nominal_list(const CLI::App& kind, const std::string& file,
                                   const std::vector<std::string>& columns) {
  return {text::read_file(file), file, columns, kNominalColumn,
          [&kind](const std::vector<std::string>& words) {
            return call_with(kind, {kNominalColumn}, options_of(kNominalColumn, words));
          }};
}

void require_axes(const importer::ImportTable& table, const model::Machine& machine, const CLI::App& kind,
                  const std::string& hint, const std::vector<std::string>& columns) {
  std::string first, set;
  for (const model::Axis& axis : machine.axes) {
    if (table.find(axis.name) != nullptr) continue;
    if (first.empty()) first = axis.name;
    set += " " + model::set_of_axis(axis);
  }
  if (first.empty()) return;
  throw text::InputError({table.file, 0}, first,
                         hint + call_with(kind, {}, columns.empty() ? set : options_of("--column", columns)));
}

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
