// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>
#include <string_view>

#include "tools/commands/command.h"
#include "tools/commands/measure/import_kinds.h"
#include "tools/fit/sanity.h"
#include "tools/import/logs/printer_file.h"
#include "tools/maths/factors.h"
#include "tools/model/artefact.h"
#include "tools/sheet/encoding.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::commands::import_cli {
namespace {

constexpr std::string_view kAllSurveys = "all";

struct PrinterArguments {
  std::string file;
  std::string series;  // number of a survey, or kAllSurveys
  std::string twist = "included";
  std::vector<double> offset;
  std::string u;  // empty: not stated
  importer::PrinterOptions options;
  ImportOutput output;
};

const char* name_of(importer::PrinterFile::Kind kind) {
  switch (kind) {
    case importer::PrinterFile::Kind::kSavedMesh:
      return "saved mesh";
    case importer::PrinterFile::Kind::kHeightMap:
      return "height map";
    case importer::PrinterFile::Kind::kProbeLog:
      return "log of touches";
  }
  return "";
}

/// Standard uncertainty of a touch, um: "5" (um), "5 um" or "0.005 mm".
double stated_u_um(const std::string& words) {
  constexpr double kMost_mm = 1;  // no printer touches so badly: the number was in another unit
  const auto bare = text::parse_number(words);
  const auto mm = bare ? std::optional(*bare / maths::kUmPerMm) : model::length_in_mm(words);
  if (!mm || !(*mm > 0) || *mm > kMost_mm)
    throw text::InputError("--u " + words + ": of the form 5 (um), 5um or 0.005mm, at most 1 mm");
  const double um = *mm * maths::kUmPerMm;
  if (um < fit::kSmallestU_um)
    throw text::InputError(
        fmt::format("--u {}: a touch of a printer is not as accurate as {:g} um. A number without unit is in "
                    "um: for {:g} mm state --u {:g}",
                    words, um, um, um * maths::kUmPerMm));
  return um;
}

void run_printer(PrinterArguments& arguments) {
  if (!arguments.u.empty()) arguments.options.u_um = stated_u_um(arguments.u);
  if (!arguments.offset.empty()) arguments.options.offset_mm = {arguments.offset[0], arguments.offset[1]};
  if (arguments.offset.size() > 2) arguments.options.z_offset_mm = arguments.offset[2];
  using Twist = importer::PrinterOptions::Twist;
  arguments.options.twist = arguments.twist == "add"      ? Twist::kAdd
                            : arguments.twist == "ignore" ? Twist::kIgnore
                                                          : Twist::kIncluded;
  if (arguments.series == kAllSurveys)
    arguments.options.series = importer::PrinterOptions::Survey::kAll;
  else if (!arguments.series.empty())
    arguments.options.series = *text::parse_count(arguments.series);
  const importer::PrinterFile read = importer::read_printer_file(
      sheet::utf8_text(text::read_file(arguments.file)), arguments.file, arguments.options);
  text::write_file(arguments.output.csv_path, importer::measurement_csv(read.table));
  const std::size_t rows = read.table.line.size();
  write_json(arguments.output.json_path, {{"kind", "printer"},
                                          {"source", name_of(read.kind)},
                                          {"profile", read.name},
                                          {"offset_mm", read.offset_mm},
                                          {"twist", read.twist},
                                          {"zero", read.zero},
                                          {"zero_known", read.zero_known},
                                          {"n_not_probed", read.not_probed},
                                          {"n_left_out", read.left_out},
                                          {"surveys", read.surveys},
                                          {"notes", read.notes},
                                          {"n_rows", rows}});
  std::FILE* out = human_stream(arguments.output.json_path);
  fmt::print(out, "{}{}: {} touches of the artefact \"{}\"\n", name_of(read.kind),
             read.name.empty() ? "" : " " + read.name, rows, arguments.options.artefact);
  if (read.twist)
    fmt::print(out,
               "z_compensations of [axis_twist_compensation]: {}. The rows are touches of the nozzle at the "
               "touched points\n",
               arguments.options.twist == Twist::kAdd
                   ? "the command adds them to the heights"
                   : "the heights include them (if the touches are older, state --twist add)");
  else if (read.kind != importer::PrinterFile::Kind::kProbeLog || read.offset_mm[0] != 0 ||
           read.offset_mm[1] != 0)
    fmt::print(
        out,
        "axis positions: the position of the nozzle; the probe is at ({:g}, {:g}) mm beside the nozzle "
        "(columns probeX, probeY)\n",
        read.offset_mm[0], read.offset_mm[1]);
  if (!read.offset_known)
    fmt::print(
        out,
        "note: the file does not state the offset of a probe: the rows are touches of the nozzle itself. "
        "If a probe touched, state --offset=X,Y in mm\n");
  if (!read.zero.empty()) fmt::print(out, "{}{}\n", read.zero_known ? "" : "note: ", read.zero);
  if (!read.surveys.empty())
    fmt::print(
        out,
        "note: the log has several surveys of the bed, which are read as one table: {}; to read one of "
        "them (if the screws of the bed were turned between them, or for the heights at one temperature), "
        "give --series with its number\n",
        read.surveys);
  for (const std::string& note : read.notes) fmt::print(out, "note: {}\n", note);
  if (read.not_probed > 0)
    fmt::print(out, "{} points of the height map have no reading and are omitted\n", read.not_probed);
  if (read.left_out > 0)
    fmt::print(out, "{} touches that the printer discarded are omitted\n", read.left_out);
  fmt::print(out,
             "{}: {} rows. The machine file needs <artefact name=\"{}\" type=\"plane\"/> in <variables>.\n",
             arguments.output.csv_path, rows, arguments.options.artefact);
}

}  // namespace

void add_printer_kind(CLI::App& kind) {
  const auto arguments = std::make_shared<PrinterArguments>();
  kind.add_option("file", arguments->file,
                  "printer.cfg with a saved mesh, klippy.log or console text, or heightmap.csv")
      ->type_name(kReads)
      ->required();
  kind.add_option("--profile", arguments->options.profile,
                  "name of the saved mesh; default: the only saved mesh");
  kind.add_option("--on", arguments->options.artefact, "name of the <artefact> of the bed")
      ->capture_default_str();
  kind.add_option(
          "--offset", arguments->offset,
          "offset of the probe from the nozzle, X,Y in mm (--offset=-38,-8), for a mesh, a height map "
          "or a log with positions of the probe; a third number is the z_offset of the probe, for a log of "
          "Klipper with \"probe at\"; default: the offset in the configuration of the file; required if the "
          "file has none")
      ->delimiter(',')
      ->expected(2, 3);
  kind.add_option("--twist", arguments->twist,
                  "z_compensations of [axis_twist_compensation] (Klipper): included (the heights include "
                  "them), add (the touches are older: the command adds them), or ignore")
      ->check(CLI::IsMember({"included", "add", "ignore"}))
      ->capture_default_str();
  kind.add_option(
          "--series", arguments->series,
          "number of the survey of the bed, from 1, if a log has several, or all: read them as one table; "
          "default: all if the temperature differs from survey to survey")
      ->check([](const std::string& word) {
        const bool known = word == kAllSurveys || text::parse_count(word);
        return known ? std::string() : "give the number of a survey, or all";
      });
  kind.add_option("--u", arguments->u,
                  "standard uncertainty of a touch: a number in um, or with its unit (0.005mm)");
  add_import_output(kind, arguments->output);
  kind.footer("vernier fit, compare and diagnose read the output (tools/docs/touch.md).");
  kind.callback([arguments] { run_printer(*arguments); });
}

}  // namespace vernier::commands::import_cli
