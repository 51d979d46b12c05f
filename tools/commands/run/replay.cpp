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

namespace vernier::commands::replay_cli {
namespace {

struct Arguments {
  std::string image, before, output, json, images;
  std::vector<std::string> measurements;
  std::vector<unsigned> dac;
  ReportHeader header;
  simulate::LoopOptions loop;
};

nlohmann::ordered_json role_json(const fit::RoleStatistics& role) {
  return {{"rms_um", text::or_null(role.rms_um)},
          {"max_um", text::or_null(role.max_um)},
          {"rms_urad", text::or_null(role.rms_urad)},
          {"n_obs", role.count}};
}

std::string um(const std::optional<double>& value) { return value ? fmt::format("{:.4g} um", *value) : "-"; }

nlohmann::ordered_json step_json(const results::ReplayStep& step, const model::Measurement& m) {
  const simulate::ReplayResult& r = step.result;
  return {{"converter", step.label},
          {"ticks", r.ticks},
          {"saturated", r.saturated},
          {"slewing", r.slewing},
          {"not_active", r.not_active},
          {"fit_before", role_json(fit::role_statistics(m, r.before, false))},
          {"fit_after", role_json(fit::role_statistics(m, r.after, false))},
          {"check_before", role_json(fit::role_statistics(m, r.before, true))},
          {"check_after", role_json(fit::role_statistics(m, r.after, true))}};
}

void print_step(std::FILE* out, const results::ReplayStep& step, const model::Measurement& m) {
  const simulate::ReplayResult& r = step.result;
  fmt::print(out, "{}: {} ticks; of these at a limit {}, at the slew limit {}, not active {}\n", step.label,
             r.ticks, r.saturated, r.slewing, r.not_active);
  for (const bool check : {false, true})
    fmt::print(out, "  rms {} rows  {} -> {}\n", check ? "check" : "fit  ",
               um(fit::role_statistics(m, r.before, check).rms_um),
               um(fit::role_statistics(m, r.after, check).rms_um));
}

void run_replay(const Arguments& arguments) {
  const auto image = compile::load_image_dir(arguments.image);
  const model::Measurement m = model::read_measurement(arguments.measurements, image->machine,
                                                       simulate::corrections_of_images(arguments.images));
  std::optional<model::Machine> before;
  if (!arguments.before.empty()) before = model::read_machine(arguments.before);
  std::vector<results::ReplayStep> steps;
  std::vector<unsigned> converters{0};
  converters.insert(converters.end(), arguments.dac.begin(), arguments.dac.end());
  for (const unsigned bits : converters) {
    simulate::LoopOptions options;
    if (bits != 0) options.dac_bits = bits;
    steps.push_back({bits == 0 ? "one image unit" : fmt::format("{} bit converter", bits),
                     simulate::replay(*image, m, options)});
  }
  nlohmann::ordered_json json = {{"machine", image->machine.name},
                                 {"steps", nlohmann::ordered_json::array()}};
  for (const results::ReplayStep& step : steps) json["steps"].push_back(step_json(step, m));
  if (!arguments.output.empty())
    text::write_file(arguments.output, report::improvement_report_html(arguments.header.on(
                                           results::replay_report(before, *image, m, steps))));
  write_json(arguments.json, json);
  for (const results::ReplayStep& step : steps) print_step(human_stream(arguments.json), step, m);
}

}  // namespace

void register_replay(CLI::App& vernier) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      vernier.add_subcommand("replay", "Compute the readings of a measurement with the correction");
  command->add_option("MEAS", arguments->measurements, "measurement files (CSV) with t")
      ->type_name(kReads)
      ->required();
  command->add_option("--image", arguments->image, "directory that compile wrote")
      ->type_name(kReadsFolder)
      ->required();
  command
      ->add_option("--dac", arguments->dac,
                   "also replay with an analogue output of 8 or 16 bit (without this option only with a "
                   "resolution of one unit of the image); may be repeated")
      ->check(CLI::IsMember({8u, 16u}));
  command
      ->add_option(
          "--before", arguments->before,
          "simpler machine file: the report compares its correction with the correction of the image")
      ->type_name(kReads);
  command->add_option("--images", arguments->images, simulate::kImagesHelp)->type_name(kReadsFolder);
  command
      ->add_option("-o,--output", arguments->output,
                   "file for the report (HTML, one file that opens without a network)")
      ->type_name(kWrites);
  add_report_header(*command, arguments->header);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "The command runs the firmware along the measured motion, and shifts every reading by the effect of "
      "the correction on\n"
      "the nominal machine. Exit status 0 done, 1 bad input, 2 the firmware never became active.");
  command->callback([arguments] { run_replay(*arguments); });
}

}  // namespace vernier::commands::replay_cli
