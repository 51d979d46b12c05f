// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/measure/import_kinds.h"
#include "tools/import/logs/laser_file.h"
#include "tools/text/files.h"

namespace vernier::commands::import_cli {
namespace {

struct LaserArguments {
  std::string file, axis, senses = "listed";
  ImportOutput output;
};

void run_laser(const LaserArguments& arguments) {
  const importer::RunSenses senses = arguments.senses == "alternate" ? importer::RunSenses::kAlternate
                                     : arguments.senses == "forward" ? importer::RunSenses::kForward
                                                                     : importer::RunSenses::kAsListed;
  const importer::LaserFile read =
      importer::read_laser_file(text::read_file(arguments.file), arguments.file, arguments.axis, senses);
  text::write_file(arguments.output.csv_path, importer::measurement_csv(read.table));
  write_json(arguments.output.json_path, {{"kind", "laser"},
                                          {"axis", read.axis},
                                          {"filetype", read.filetype},
                                          {"machine", read.machine},
                                          {"date", read.date},
                                          {"n_targets", read.targets},
                                          {"n_runs", read.runs},
                                          {"n_left_out", read.left_out},
                                          {"n_rows", read.table.line.size()}});
  std::FILE* out = human_stream(arguments.output.json_path);
  fmt::print(out, "axis {}, {} targets, {} runs; targets taken as mm, deviations as µm\n", read.axis,
             read.targets, read.runs);
  if (read.left_out > 0)
    fmt::print(out,
               "{} runs contain only zeros, because the test is unidirectional; these runs are omitted\n",
               read.left_out);
  fmt::print(out, "{}: {} rows\n", arguments.output.csv_path, read.table.line.size());
}

}  // namespace

void add_laser_kind(CLI::App& kind) {
  const auto arguments = std::make_shared<LaserArguments>();
  kind.add_option("file", arguments->file, "file of targets and runs")->type_name(kReads)->required();
  kind.add_option("--axis", arguments->axis,
                  "name of the measured axis; default: the axis that the file states");
  kind.add_option("--senses", arguments->senses,
                  "approach directions of the runs: listed (from the order of the lines), alternate (odd "
                  "runs forward, even runs back), or forward")
      ->check(CLI::IsMember({"listed", "alternate", "forward"}));
  add_import_output(kind, arguments->output);
  kind.footer("vernier evaluate iso230-2 reads the output.");
  kind.callback([arguments] { run_laser(*arguments); });
}

}  // namespace vernier::commands::import_cli
