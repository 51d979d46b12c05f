// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/command.h"

#include <fmt/format.h>

#include <memory>

#include "tools/compile/symbolic/functions.h"
#include "tools/model/machine_reader.h"
#include "tools/simulate/simulate.h"
#include "tools/text/error.h"

namespace vernier::commands::simulate_cli {
namespace {

struct Arguments {
  std::string truth, image, path, json, output;
  unsigned dac = 0;
  simulate::LoopOptions loop;
};

void print_result(std::FILE* out, const simulate::SimulateResult& r, const simulate::LoopOptions& options) {
  fmt::print(out, "{} ticks after {} ticks of pre-roll, {}\n", r.states.count, r.loop.pre_roll,
             options.dac_bits ? fmt::format("{} bit converter", *options.dac_bits) : "one image unit");
  fmt::print(out, "error before   rms {:.4g} um   max {:.4g} um\n", r.rms_before_um, r.max_before_um);
  fmt::print(out, "error after    rms {:.4g} um   max {:.4g} um\n", r.rms_after_um, r.max_after_um);
  fmt::print(out, "tilt before    max {:.4g} deg\n", r.tilt_before.maxCoeff());
  fmt::print(
      out, "tilt after     max {:.4g} deg{}\n", r.tilt_after.maxCoeff(),
      r.damped > 0
          ? fmt::format(", the correction of the tool direction was damped near singular poses in {} ticks",
                        r.damped)
          : "");
  fmt::print(out, "ticks saturated {}, slewing {}, beyond a declared range {}, overrun {}\n",
             r.loop.saturated, r.loop.slewing, r.loop.beyond_range, r.loop.health.overruns);
  if (r.loop.fault != Fault::kNone)
    fmt::print(out, "FAULT {}: {} ticks without full correction\n", name_of(r.loop.fault), r.loop.not_active);
}

void run_simulate(Arguments arguments) {
  if (arguments.dac != 0) arguments.loop.dac_bits = arguments.dac;
  const model::Machine truth = model::read_machine(arguments.truth);
  const auto image = compile::load_image_dir(arguments.image);
  const simulate::Path path = simulate::read_path(arguments.path);
  const simulate::SimulateResult result = simulate::simulate(truth, *image, path, arguments.loop);
  const nlohmann::ordered_json json = simulate::simulate_json(result, image->machine, arguments.loop);
  if (!arguments.output.empty())
    text::write_file(arguments.output, simulate::ticks_csv(result, image->machine));
  write_json(arguments.json, json);
  print_result(human_stream(arguments.json), result, arguments.loop);
}

}  // namespace

void register_simulate(CLI::App& vernier) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      vernier.add_subcommand("simulate", "Run the firmware loop on a simulated machine with known errors");
  command->add_option("--truth", arguments->truth, "machine file of the true machine (XML)")
      ->type_name(kReads)
      ->required();
  command->add_option("--image", arguments->image, "directory that compile wrote")
      ->type_name(kReadsFolder)
      ->required();
  command->add_option("--path", arguments->path, "path (CSV): t[s], every axis, inputs")
      ->type_name(kReads)
      ->required();
  command
      ->add_option("--dac", arguments->dac,
                   "bits of the analogue output of the correction, 8 or 16; default: a digital output with a "
                   "resolution of one unit of the image")
      ->check(CLI::IsMember({8u, 16u}));
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command
      ->add_option("-o,--output", arguments->output,
                   "output file with the corrections and errors of every tick (CSV)")
      ->type_name(kWrites);
  command
      ->add_option("--noise-um", arguments->loop.noise_um,
                   "standard deviation of the noise of the position readings")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--delay-ticks", arguments->loop.delay_ticks, "age of the position readings, in ticks")
      ->check(CLI::Range(0, 1000));
  command->add_option("--seed", arguments->loop.seed, "seed of the noise")->capture_default_str();
  command->footer(
      "The error of a tick (control cycle) is p_truth(q + correction) - p_nominal(q) after the best rigid "
      "alignment of the whole\n"
      "path; the error before is that with correction 0. The tilt is the angle between the two tool "
      "directions, without\n"
      "alignment. The first counted tick is the first tick in mode Active: until then the machine is at the "
      "first point of the\n"
      "path, with the speed of the first tick. The analogue output has 0-10 V, 25 um/V, 5 V = zero; with 8 "
      "bits a step of\n"
      "0.98 um and +-124.5 um.\n"
      "Exit status 0 done, 1 bad input, 2 the firmware never became active.");
  command->callback([arguments] { run_simulate(*arguments); });
}

}  // namespace vernier::commands::simulate_cli
