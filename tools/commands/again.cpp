// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tools/commands/command.h"
#include "tools/provenance/made_file.h"
#include "tools/text/error.h"

namespace vernier::commands::again_cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string file, json;
};

/// The first difference of two texts.
struct Difference {
  std::size_t byte = 0, line = 1;  // both from 1
};

Difference first_difference(const std::string& a, const std::string& b) {
  const auto [left, right] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return {static_cast<std::size_t>(left - a.begin()) + 1,
          static_cast<std::size_t>(std::count(a.begin(), left, '\n')) + 1};
}

void run_again(const Arguments& arguments) {
  const provenance::MadeFile again(arguments.file);
  const std::vector<std::string> changed = again.changed_inputs();
  const std::vector<provenance::Remade> remade = again.remade();
  nlohmann::ordered_json json = {{"file", again.file()},
                                 {"same", true},
                                 {"files", remade.size()},
                                 {"bytes", again.content().size()},
                                 {"program", again.made().program},
                                 {"command", again.made().command},
                                 {"changed_inputs", changed}};
  std::FILE* const out = human_stream(arguments.json);
  fmt::print(out, "made by: {}\ncommand: vernier {}\n", again.made().program,
             fmt::join(again.made().command, " "));
  for (const std::string& name : changed) fmt::print(out, "changed since: {}\n", name);
  for (const provenance::Remade& one : remade) {
    const std::string now = fs::exists(one.name) ? text::read_file(one.name) : "";
    if (now == one.text) {
      fmt::print(out, "{}: made again, all {} bytes are equal\n", one.name, now.size());
      continue;
    }
    const Difference first = first_difference(now, one.text);
    json["same"] = false;
    json["first_difference"] = {{"file", one.name}, {"byte", first.byte}, {"line", first.line}};
    write_json(arguments.json, json);
    throw text::LimitNotMet(fmt::format(
        "{}: made again, and the bytes differ from byte {} on (line {}){}", one.name, first.byte, first.line,
        changed.empty() ? ""
                        : ". These inputs have changed since the file was made: " +
                              fmt::format("{}", fmt::join(changed, ", "))));
  }
  write_json(arguments.json, json);
}

}  // namespace

void register_again(CLI::App& vernier) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = vernier.add_subcommand(
      "again", "Make a report or result again from the same inputs, and compare all bytes");
  command
      ->add_option("file", arguments->file,
                   "report (HTML), machine file (XML), result (JSON), or the folder of improve or compile")
      ->type_name(kReads)
      ->required();
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "FILE contains a record: the command that made the file, its folder, and the SHA-256 of each\n"
      "input file. `vernier again` runs this command in a temporary folder with copies of the inputs,\n"
      "and does not change FILE.\n"
      "Exit status: 0 all bytes are equal, 1 bad input (FILE has no record, or an input is missing),\n"
      "2 the bytes differ, because an input or the program has changed.");
  command->callback([arguments] { run_again(*arguments); });
}

}  // namespace vernier::commands::again_cli
