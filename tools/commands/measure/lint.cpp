// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/lint.h"

#include <fmt/format.h>

#include <memory>

#include "tools/commands/command.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::commands::lint_cli {
namespace {

struct LintArguments {
  std::vector<std::string> files;
  std::string json;
};

nlohmann::ordered_json result_json(const std::vector<lint::LintedFile>& files) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array(), findings = nlohmann::ordered_json::array();
  for (const lint::LintedFile& file : files) {
    list.push_back(
        {{"file", file.file}, {"kind", lint::linted_kind_name(file.kind)}, {"usable", file.usable}});
    for (const lint::LintFinding& finding : file.findings) findings.push_back(lint::finding_json(finding));
  }
  return {{"files", list}, {"findings", findings}};
}

void run_lint(const LintArguments& arguments) {
  const std::vector<lint::LintedFile> files = lint::lint_files(arguments.files);
  write_json(arguments.json, result_json(files));
  std::FILE* out = human_stream(arguments.json);
  std::size_t useless = 0;
  for (const lint::LintedFile& file : files) {
    for (const lint::LintFinding& finding : file.findings)
      fmt::print(out, "{}\n", lint::in_one_line(finding));
    if (file.findings.empty())
      fmt::print(out, "{}: no error and no unusual entry in this {} file\n", text::printable(file.file),
                 lint::linted_kind_name(file.kind));
    useless += file.usable ? 0 : 1;
  }
  if (useless > 0)
    throw text::InputError(
        useless == 1 ? std::string("one file has errors, and the commands cannot read it")
                     : fmt::format("{} files have errors, and the commands cannot read them", useless));
}

}  // namespace

void register_lint(CLI::App& vernier) {
  auto arguments = std::make_shared<LintArguments>();
  CLI::App* command =
      vernier.add_subcommand("lint", "Report errors and unusual entries in machine and measurement files");
  command->add_option("FILE", arguments->files, "machine files (XML) and measurement files (CSV) in any mix")
      ->type_name(kReads)
      ->required();
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "error: the file cannot be used; warning: the file can be used, but its meaning may differ from the "
      "intended\n"
      "meaning; remark: for information. If a machine file is among the files, the command compares the "
      "measurement\n"
      "files with the machine file. Exit status 0 if no file has an error, else 1.");
  command->callback([arguments] { run_lint(*arguments); });
}

}  // namespace vernier::commands::lint_cli
