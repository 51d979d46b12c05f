// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/report_header.h"
#include "tools/model/machine_reader.h"
#include "tools/report/report.h"
#include "tools/results/replay_report.h"
#include "tools/simulate/corrected.h"
#include "tools/simulate/replay.h"
#include "tools/text/error.h"
#include "tools/text/optional_json.h"

namespace vernier::replay_cli {
namespace {

struct Arguments {
  std::string image, before, output, json, images;
  std::vector<std::string> measurements;
  std::vector<unsigned> dac;
  ReportHeader header;
  LoopOptions loop;
};

nlohmann::ordered_json role_json(const RoleStatistics& role) {
  return {{"rms_um", or_null(role.rms_um)},
          {"max_um", or_null(role.max_um)},
          {"rms_urad", or_null(role.rms_urad)},
          {"n_obs", role.count}};
}

std::string um(const std::optional<double>& value) { return value ? fmt::format("{:.4g} um", *value) : "-"; }

nlohmann::ordered_json step_json(const ReplayStep& step, const Measurement& m) {
  const ReplayResult& r = step.result;
  return {{"converter", step.label},
          {"ticks", r.ticks},
          {"saturated", r.saturated},
          {"slewing", r.slewing},
          {"not_active", r.not_active},
          {"fit_before", role_json(role_statistics(m, r.before, false))},
          {"fit_after", role_json(role_statistics(m, r.after, false))},
          {"check_before", role_json(role_statistics(m, r.before, true))},
          {"check_after", role_json(role_statistics(m, r.after, true))}};
}

void print_step(std::FILE* out, const ReplayStep& step, const Measurement& m) {
  const ReplayResult& r = step.result;
  fmt::print(out, "{}: {} ticks, at a limit {}, slewing {}, not active {}\n", step.label, r.ticks,
             r.saturated, r.slewing, r.not_active);
  for (const bool check : {false, true})
    fmt::print(out, "  rms {} rows  {} -> {}\n", check ? "check" : "fit  ",
               um(role_statistics(m, r.before, check).rms_um), um(role_statistics(m, r.after, check).rms_um));
}

void run_replay(const Arguments& arguments) {
  const auto image = load_image_dir(arguments.image);
  const Measurement m =
      read_measurement(arguments.measurements, image->machine, corrections_of_images(arguments.images));
  std::optional<Machine> before;
  if (!arguments.before.empty()) before = read_machine(arguments.before);
  std::vector<ReplayStep> steps;
  std::vector<unsigned> converters{0};
  converters.insert(converters.end(), arguments.dac.begin(), arguments.dac.end());
  for (const unsigned bits : converters) {
    LoopOptions options;
    if (bits != 0) options.dac_bits = bits;
    steps.push_back(
        {bits == 0 ? "one image unit" : fmt::format("{} bit converter", bits), replay(*image, m, options)});
  }
  nlohmann::ordered_json json = {{"machine", image->machine.name},
                                 {"steps", nlohmann::ordered_json::array()}};
  for (const ReplayStep& step : steps) json["steps"].push_back(step_json(step, m));
  if (!arguments.output.empty())
    write_file(arguments.output,
               improvement_report_html(arguments.header.on(replay_report(before, *image, m, steps))));
  write_json(arguments.json, json);
  for (const ReplayStep& step : steps) print_step(human_stream(arguments.json), step, m);
}

}  // namespace

void register_replay(CLI::App& vernier) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      vernier.add_subcommand("replay", "What would a measurement have read with the correction running?");
  command->add_option("MEAS", arguments->measurements, "measurement files (CSV) with t")->required();
  command->add_option("--image", arguments->image, "directory that compile wrote")->required();
  command
      ->add_option("--dac", arguments->dac,
                   "analogue chain of 8 or 16 bit in between, beside one image unit; may be repeated")
      ->check(CLI::IsMember({8u, 16u}));
  command->add_option("--before", arguments->before,
                      "a simpler machine file, to stand beside the image's in the report");
  command->add_option("--images", arguments->images, kImagesHelp);
  command->add_option("-o,--output", arguments->output, "the report, one HTML file that opens offline");
  add_report_header(*command, arguments->header);
  command->add_option("--json", arguments->json, "result for programs; - for standard output");
  command->footer(
      "Runs the firmware along the measured motion and moves every reading by what its correction does to\n"
      "the nominal machine. Exit status 0 done, 1 bad input, 2 the firmware never became active.");
  command->callback([arguments] { run_replay(*arguments); });
}

}  // namespace vernier::replay_cli
