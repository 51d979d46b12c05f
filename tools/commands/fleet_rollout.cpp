// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/commands/command.h"
#include "tools/commands/fleet_kinds.h"
#include "tools/commands/upload_kinds.h"
#include "tools/fleet/rollout.h"
#include "tools/registry/digest.h"
#include "tools/registry/shell_command.h"
#include "tools/text/error.h"
#include "tools/text/wall_time.h"

namespace vernier::commands::fleet_cli {
namespace {

using Json = nlohmann::ordered_json;

struct RolloutArguments {
  std::string registry, images, key, stages = "1,10%,50%,100%", signed_by, json;
  std::vector<std::string> machines;
  fleet::RolloutOptions options;
  bool go_on = false;
};

std::string folder_for(std::string pattern, const std::string& machine) {
  const std::string mark = "{machine}";
  for (std::size_t at = pattern.find(mark); at != std::string::npos;
       at = pattern.find(mark, at + machine.size()))
    pattern.replace(at, mark.size(), machine);
  return pattern;
}

/// Every image is read and judged before the first board is asked anything.
std::vector<fleet::RolloutMachine> machines_of(const RolloutArguments& arguments,
                                               registry::Registry& registry) {
  std::vector<fleet::RolloutMachine> machines;
  std::vector<std::string> names = arguments.machines;
  if (names.empty())
    for (const registry::FleetMachine& one : registry.machines())
      if (!one.url.empty() && std::filesystem::is_directory(folder_for(arguments.images, one.name)))
        names.push_back(one.name);
  if (names.empty())
    throw text::InputError({}, arguments.images, "no machine with a board has an image there");
  const std::vector<std::size_t> ends = fleet::stage_ends(arguments.stages, names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const registry::FleetMachine one = registry.machine(names[i]);
    if (one.url.empty())
      throw text::InputError({}, one.name, "this machine has no board: vernier fleet add --url");
    const auto stage = std::upper_bound(ends.begin(), ends.end(), i) - ends.begin();
    machines.push_back(
        {one.name, one.url, upload_cli::safe_image(folder_for(arguments.images, one.name)), stage});
  }
  return machines;
}

void write_kept(registry::Registry& registry, const RolloutArguments& arguments,
                const fleet::RolloutMachine& machine) {
  const std::string folder = folder_for(arguments.images, machine.name);
  registry::RecordedCalibration one;
  one.machine = machine.name, one.model = folder + "/machine.xml";
  if (std::filesystem::exists(one.model)) one.model_hash = registry::digest_of(text::read_file(one.model));
  for (const fleet::RolloutState& state : fleet::rollout_states(registry, arguments.options.name))
    if (state.machine == machine.name) one.image = state.image;
  one.signed_by = arguments.signed_by;
  one.checked_against = arguments.options.judge.empty()
                            ? "watched by the rollout " + arguments.options.name
                            : registry::command_for(arguments.options.judge, machine.name);
  one.at_us = text::now_us();
  registry.put(one);
}

void tell(const RolloutArguments& arguments, registry::Registry& registry) {
  Json all = Json::array();
  std::FILE* const out = human_stream(arguments.json);
  for (const fleet::RolloutState& one : fleet::rollout_states(registry, arguments.options.name)) {
    all.push_back({{"machine", one.machine},
                   {"stage", one.stage + 1},
                   {"state", one.state},
                   {"said", one.said},
                   {"image", one.image}});
    fmt::print(out, "{:<20} stage {:<3} {:<11} {} {}\n", one.machine, one.stage + 1, one.state, one.image,
               one.said);
  }
  write_json(arguments.json, {{"rollout", arguments.options.name}, {"machines", all}});
}

void run_rollout(const RolloutArguments& arguments) {
  registry::Registry registry = open_registry(arguments.registry);
  if (arguments.images.empty()) {
    if (fleet::rollout_states(registry, arguments.options.name).empty())
      throw text::InputError({}, arguments.options.name, "no rollout of this name; --images begins one");
    return tell(arguments, registry);
  }
  const auto key = upload::given_key(arguments.key);
  if (!key) throw text::InputError("--key is missing: the secret key that signs the images");
  if (arguments.signed_by.empty())
    throw text::InputError("--signed-by is missing: who answers for the images");
  RolloutArguments mine = arguments;
  mine.options.key = *key;
  const std::vector<fleet::RolloutMachine> machines = machines_of(mine, registry);
  if (mine.go_on) fleet::allow_rollout(registry, mine.options.name);
  std::exception_ptr stood;
  until_told([&](const std::atomic<bool>& stop) {
    try {
      fleet::roll_out(registry, machines, mine.options, stop, say_line,
                      [&](const fleet::RolloutMachine& one) { write_kept(registry, mine, one); });
    } catch (const text::LimitNotMet&) {
      stood = std::current_exception();
    }
  });
  tell(mine, registry);
  if (stood) std::rethrow_exception(stood);
}

}  // namespace

void add_rollout(CLI::App& fleet) {
  const auto arguments = std::make_shared<RolloutArguments>();
  CLI::App* command = fleet.add_subcommand("rollout",
                                           "images to boards by stages: tried, watched, judged, kept; stops "
                                           "at the first worse machine and takes it back");
  command
      ->add_option("NAME", arguments->options.name, "of this rollout; called again it goes on where it was")
      ->required();
  add_registry(*command, arguments->registry);
  command->add_option(
      "--images", arguments->images,
      "directories that `vernier compile` wrote, {machine} in the name; without it: how far it is");
  command->add_option("--key", arguments->key, "secret key of `vernier keys` (or VERNIER_KEY)");
  command->add_option("--signed-by", arguments->signed_by,
                      "who answers for the images; stands in the registry");
  command->add_option("--machine", arguments->machines,
                      "these, in this order; default: all that have a board and an image");
  command->add_option("--stages", arguments->stages, "how many machines until the end of each stage")
      ->capture_default_str();
  command->add_option("--watch", arguments->options.watch_s, "s on trial before it is judged")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
  command->add_option(
      "--judge", arguments->options.judge,
      "command for a shell, {machine} for the name: 0 not worse; anything else takes the image back");
  command->add_flag("--go-on", arguments->go_on,
                    "a rollout that stands goes on, with the machine where it stopped");
  command->add_option("--json", arguments->json,
                      "where each machine stands, for programs; - for standard output");
  command->footer(
      "The judge must answer within the board's own trial time, e.g. measure and `vernier compare --limit`.\n"
      "Exit status 0 all kept, 1 bad input (no board was asked), 2 it stands: a machine was worse or away.");
  command->callback([arguments] { run_rollout(*arguments); });
}

}  // namespace vernier::commands::fleet_cli
