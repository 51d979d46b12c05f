// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/commands/command.h"
#include "tools/commands/fleet/fleet_kinds.h"
#include "tools/commands/run/upload_kinds.h"
#include "tools/commands/until_told.h"
#include "tools/fleet/rollout.h"
#include "tools/registry/digest.h"
#include "tools/registry/machine_name.h"
#include "tools/text/assurance.h"
#include "tools/text/error.h"
#include "tools/text/wall_time.h"

namespace vernier::commands::fleet_cli {
namespace {

using Json = nlohmann::ordered_json;

struct RolloutArguments {
  std::string registry, images, key, stages = "1,10%,50%,100%", signed_by, json;
  std::vector<std::string> machines;
  fleet::RolloutOptions options;
};

/// Required identity of the board of a machine. Without a name in the registry no identity can be proved.
upload::BoardClaim claim_of(const registry::FleetMachine& one) {
  if (one.board.empty())
    throw text::InputError(
        {}, one.name,
        fmt::format(
            "the registry has no board name for this machine; add the name: vernier fleet add {} --board "
            "NAME --board-key KEY, or --trust to store name and key of the board that answers at the address",
            one.name));
  upload::BoardClaim claim{one.board, std::nullopt};
  if (!one.board_key.empty()) claim.key = upload::parse_board_key(one.board_key);
  return claim;
}

/// Two machines with one board would be one image over another.
void refuse_shared_boards(const std::vector<fleet::RolloutMachine>& machines) {
  for (std::size_t i = 0; i < machines.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const bool same_key = machines[i].claim.key && machines[i].claim.key == machines[k].claim.key;
      if (!same_key && machines[i].url != machines[k].url) continue;
      throw text::InputError(
          {}, machines[i].name,
          fmt::format("{}{}: each machine needs a different board",
                      std::string(same_key ? "has the board key of " : "has the address of "),
                      machines[k].name));
    }
}

/// Every image is read and judged before the first board is asked anything.
std::vector<fleet::RolloutMachine> machines_of(const RolloutArguments& arguments,
                                               registry::Registry& registry) {
  std::vector<fleet::RolloutMachine> machines;
  std::vector<std::string> names = arguments.machines;
  if (names.empty())
    for (const registry::FleetMachine& one : registry.machines())
      if (!one.url.empty() &&
          std::filesystem::is_directory(registry::for_machine(arguments.images, one.name)))
        names.push_back(one.name);
  if (names.empty())
    throw text::InputError({}, arguments.images,
                           "these directories contain no correction image of a machine that has a board");
  const std::vector<std::size_t> ends = fleet::stage_ends(arguments.stages, names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const registry::FleetMachine one = registry.machine(names[i]);
    if (one.url.empty())
      throw text::InputError({}, one.name, "this machine has no board: vernier fleet add --url");
    const auto stage = std::upper_bound(ends.begin(), ends.end(), i) - ends.begin();
    machines.push_back({one.name, one.url, claim_of(one),
                        upload_cli::safe_image(registry::for_machine(arguments.images, one.name)), stage});
  }
  refuse_shared_boards(machines);
  return machines;
}

void write_kept(registry::Registry& registry, const RolloutArguments& arguments,
                const fleet::RolloutMachine& machine) {
  const std::string folder = registry::for_machine(arguments.images, machine.name);
  registry::RecordedCalibration one;
  one.machine = machine.name, one.model = folder + "/machine.xml";
  if (std::filesystem::exists(one.model)) one.model_hash = registry::digest_of(text::read_file(one.model));
  for (const fleet::RolloutState& state : fleet::rollout_states(registry, arguments.options.name))
    if (state.machine == machine.name) one.image = state.image;
  one.signed_by = arguments.signed_by;
  one.checked_against = arguments.options.judge.empty()
                            ? "watched by the rollout " + arguments.options.name
                            : registry::for_machine(arguments.options.judge, machine.name);
  one.at_us = text::now_us();
  registry.put(one);
}

/// The assurance of the call; end null: no board was asked.
text::Assurance vouch(const RolloutArguments& arguments, const std::vector<fleet::RolloutState>& states,
                      const fleet::RolloutEnd* end) {
  text::Assurance assurance(text::AssuranceKind::kRollout);
  if (end == nullptr) {
    assurance.not_covered(
        "the command did not connect to a board: the state is from earlier calls, as the registry stores it");
    return assurance;
  }
  const auto total = static_cast<double>(states.size());
  const auto kept =
      std::count_if(states.begin(), states.end(), [](const auto& s) { return s.state == "kept"; });
  assurance.at_least(
      "kept", static_cast<double>(kept), total,
      fmt::format("{} of {} machines confirmed their correction image after its trial", kept, states.size()));
  assurance.at_least(
      "in-effect", static_cast<double>(end->in_effect.size()), total,
      fmt::format("{} of {} boards answered at the end of the call as the board of their machine, "
                  "with the image in effect",
                  end->in_effect.size(), states.size()));
  assurance.require(
      "not-stopped", end->stood.empty(),
      end->stood.empty() ? "the rollout reached its last stage" : "the rollout has stopped: " + end->stood);
  for (const std::string& note : end->notes) assurance.not_covered(note);
  if (arguments.options.judge.empty())
    assurance.not_covered("whether the machines are more accurate, because the option --judge is missing");
  assurance.not_covered("The command did not observe the boards after the end of this call");
  return assurance;
}

/// Exit status 0 only if this is true, or if no board was asked.
bool tell(const RolloutArguments& arguments, registry::Registry& registry, const fleet::RolloutEnd* end) {
  Json all = Json::array();
  const std::vector<fleet::RolloutState> states = fleet::rollout_states(registry, arguments.options.name);
  std::FILE* const out = human_stream(arguments.json);
  for (const fleet::RolloutState& one : states) {
    all.push_back({{"machine", one.machine},
                   {"stage", one.stage + 1},
                   {"state", one.state},
                   {"said", one.said},
                   {"image", one.image},
                   {"at", text::utc_text(one.at_us)}});
    fmt::print(out, "{:<20} stage {:<3} {:<13} {} {} {}\n", one.machine, one.stage + 1, one.state, one.image,
               text::utc_text(one.at_us), one.said);
  }
  const text::Assurance assurance = vouch(arguments, states, end);
  for (const std::string& one : assurance.uncovered()) fmt::print(out, "not looked at: {}\n", one);
  write_json(arguments.json,
             {{"rollout", arguments.options.name}, {"machines", all}, {"assurance", assurance.json()}});
  return assurance.holds();
}

void run_rollout(const RolloutArguments& arguments) {
  registry::Registry registry = open_registry(arguments.registry);
  if (arguments.images.empty()) {
    if (fleet::rollout_states(registry, arguments.options.name).empty())
      throw text::InputError({}, arguments.options.name, "no rollout has this name; begin one with --images");
    tell(arguments, registry, nullptr);
    return;
  }
  const auto key = upload::given_key(arguments.key);
  if (!key)
    throw text::InputError(
        "--key is missing: give the file of the secret key with which the command signs the correction "
        "images");
  if (arguments.signed_by.empty())
    throw text::InputError("--signed-by is missing: name the person responsible for the correction images");
  RolloutArguments mine = arguments;
  mine.options.key = *key;
  const std::vector<fleet::RolloutMachine> machines = machines_of(mine, registry);
  fleet::RolloutEnd end;
  constexpr int kNotAll = 2;
  until_told(
      [&](const std::atomic<bool>& stop) {
        end = fleet::roll_out(registry, machines, mine.options, stop, say_line,
                              [&](const fleet::RolloutMachine& one) { write_kept(registry, mine, one); });
      },
      [] {}, kNotAll);
  const bool holds = tell(mine, registry, &end);
  if (!end.stood.empty()) throw text::LimitNotMet(end.stood);
  if (!holds)
    throw text::LimitNotMet(
        "at least one machine of this rollout does not run its confirmed correction image");
}

/// Without its registry a rollout stops, because its steps could not be recorded.
void run_or_stand(const RolloutArguments& arguments) {
  try {
    run_rollout(arguments);
  } catch (const registry::DatabaseError& error) {
    throw text::LimitNotMet(
        fmt::format("the registry failed: {}: the rollout has stopped; each board reverts its image on trial "
                    "by itself; call the command again when the registry is available",
                    error.what()));
  }
}

}  // namespace

void add_rollout(CLI::App& fleet) {
  const auto arguments = std::make_shared<RolloutArguments>();
  CLI::App* command = fleet.add_subcommand(
      "rollout",
      "send correction images to boards in stages: trial, judgement, confirmation. At the first machine that "
      "becomes less accurate the rollout reverts the image and stops");
  command->add_option("NAME", arguments->options.name, "name of this rollout; a second call continues it")
      ->required();
  add_registry(*command, arguments->registry);
  command->add_option("--images", arguments->images,
                      "directories that `vernier compile` wrote, {machine} in the name; without this option "
                      "the command prints the state of the rollout");
  command->add_option("--key", arguments->key, "secret key of `vernier keys` (or VERNIER_KEY)")
      ->type_name(kReads);
  command->add_option("--signed-by", arguments->signed_by,
                      "person responsible for the correction images; the registry stores this name");
  command->add_option("--machine", arguments->machines,
                      "names of the machines, in the order of the rollout; default: all machines that have a "
                      "board and a correction image");
  command
      ->add_option("--stages", arguments->stages,
                   "size of each stage: total number of machines at the end of the stage")
      ->capture_default_str();
  command
      ->add_option("--watch", arguments->options.watch_s,
                   "time in s for which a correction image must run on trial without interruption before its "
                   "accuracy is judged")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
  command->add_option(
      "--judge", arguments->options.judge,
      "shell command that evaluates a machine with the new image, {machine} in place of the name: exit "
      "status 0: the machine is not worse; any other exit status reverts the image");
  command
      ->add_option("--settle", arguments->options.settle_s,
                   "time in s within which the board must start to use a correction image")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command
      ->add_option("--lease", arguments->options.lease_s,
                   "duration of the lock on a machine, s: after a call was killed, another call must wait "
                   "for this time. The value must be longer than the slowest answer of a board")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str();
  command->add_flag("--go-on", arguments->options.go_on,
                    "continue a stopped rollout, with the machine at which it stopped");
  command->add_flag(
      "--take-over-trial", arguments->options.take_over_trial,
      "revert a trial that another caller began on a board; without this option the board is refused");
  command->add_option("--json", arguments->json,
                      "file for the state of each machine as JSON, for programs; - for standard output");
  command->footer(
      "The judge command must answer within the trial time of the board, e.g. measure and `vernier compare "
      "--limit`.\n"
      "Before the command signs or sends an image, each board must state its name and prove its key (vernier "
      "fleet add --board, --board-key, --trust).\n"
      "Exit status 0 all images are kept and in effect (without --images: the state is printed), 1 bad input "
      "(no request was sent to a board),\n"
      "2 the rollout has stopped: a machine was worse or not available, a board was another board, an image "
      "was not in effect, or another caller has one of the machines.");
  command->callback([arguments] { run_or_stand(*arguments); });
}

}  // namespace vernier::commands::fleet_cli
