#include <fmt/format.h>

#include <memory>

#include "tools/cli/command.h"
#include "tools/model/error.h"
#include "tools/simulate/replay.h"

namespace vernier {
namespace {

struct Arguments {
  std::string image, json;
  std::vector<std::string> measurements;
  unsigned dac = 0;
  LoopOptions loop;
};

nlohmann::ordered_json role_json(const RoleStatistics& role) {
  const auto or_null = [](const std::optional<double>& v) {
    return v ? nlohmann::ordered_json(*v) : nlohmann::ordered_json(nullptr);
  };
  return {{"rms_um", or_null(role.rms_um)},
          {"max_um", or_null(role.max_um)},
          {"rms_urad", or_null(role.rms_urad)},
          {"n_obs", role.count}};
}

std::string um(const std::optional<double>& value) { return value ? fmt::format("{:.4g} um", *value) : "-"; }

void run_replay(Arguments arguments) {
  if (arguments.dac != 0) arguments.loop.dac_bits = arguments.dac;
  const auto image = load_image_dir(arguments.image);
  const Measurement m = read_measurement(arguments.measurements, image->machine);
  const ReplayResult result = replay(*image, m, arguments.loop);
  const RoleStatistics fit_before = role_statistics(m, result.before, false),
                       fit_after = role_statistics(m, result.after, false);
  const RoleStatistics check_before = role_statistics(m, result.before, true),
                       check_after = role_statistics(m, result.after, true);
  const nlohmann::ordered_json json = {{"ticks", result.ticks},
                                       {"saturated", result.saturated},
                                       {"slewing", result.slewing},
                                       {"not_active", result.not_active},
                                       {"fit_before", role_json(fit_before)},
                                       {"fit_after", role_json(fit_after)},
                                       {"check_before", role_json(check_before)},
                                       {"check_after", role_json(check_after)}};
  write_json(arguments.json, json);
  std::FILE* out = human_stream(arguments.json);
  fmt::print(out, "{} ticks, saturated {}, slewing {}, not active {}\n", result.ticks, result.saturated,
             result.slewing, result.not_active);
  fmt::print(out, "rms fit rows    {} -> {}\n", um(fit_before.rms_um), um(fit_after.rms_um));
  fmt::print(out, "rms check rows  {} -> {}\n", um(check_before.rms_um), um(check_after.rms_um));
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
                   "analogue chain of 8 or 16 bit in between; default: one image unit")
      ->check(CLI::IsMember({8u, 16u}));
  command->add_option("--json", arguments->json, "result for programs; - for standard output");
  command->footer(
      "Runs the firmware along the measured motion and moves every reading by what its correction does to\n"
      "the nominal machine. Exit status 0 done, 1 bad input, 2 the firmware never became active.");
  command->callback([arguments] { run_replay(*arguments); });
}

}  // namespace vernier
