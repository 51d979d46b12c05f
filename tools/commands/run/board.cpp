// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "tools/commands/command.h"
#include "tools/commands/run/board_claim.h"
#include "tools/text/error.h"
#include "tools/upload/client.h"
#include "tools/upload/open_transport.h"

namespace vernier::commands::board_cli {
namespace {

struct Arguments {
  std::string url, what, axis, key, json;
  ClaimWords claim;
  double weight = 1;
};

struct Named {
  const char* name;
  Command command;
};
constexpr Named kCommands[] = {{"activate", Command::kActivate},
                               {"deactivate", Command::kDeactivate},
                               {"clear", Command::kClearFault},
                               {"hold", Command::kHold},
                               {"release", Command::kRelease}};
// A command is taken by the next tick; a board that has not moved on by then does not tick.
constexpr auto kTakenAfter = std::chrono::milliseconds(50);

void set_weight(const Arguments& arguments, upload::Client& client) {
  const auto& axes = client.info().axes;
  const auto found = std::find_if(
      axes.begin(), axes.end(), [&](const upload::BoardSignal& axis) { return axis.name == arguments.axis; });
  if (found == axes.end())
    throw text::InputError(fmt::format("--axis \"{}\": the board has no such axis", arguments.axis));
  client.weight(static_cast<std::uint8_t>(found - axes.begin()), arguments.weight);
}

/// Identity of the board, for `vernier fleet add --board NAME --board-key KEY`.
void identify(const Arguments& arguments, upload::Client& client) {
  const auto key = client.proved_key();
  const std::string& name = client.info().board;
  fmt::print(
      human_stream(arguments.json), "board {}, {}\n", name.empty() ? "without a name" : name,
      key ? "key " + upload::board_key_text(*key) : "no board key: the board cannot prove its identity");
  nlohmann::ordered_json json = {{"board", name}, {"board_key", nullptr}};
  if (key) json["board_key"] = upload::board_key_text(*key);
  write_json(arguments.json, json);
}

void run(const Arguments& arguments) {
  upload::Client client(upload::open_transport(upload::parse_url(arguments.url)));
  client.sign_with(upload::given_key(arguments.key));
  require_claim(client, arguments.claim);
  if (arguments.what == "identify") return identify(arguments, client);
  if (arguments.what == "weight") {
    set_weight(arguments, client);
  } else {
    const std::uint64_t refused = client.health().refused_commands;
    for (const Named& named : kCommands)
      if (arguments.what == named.name) client.command(named.command);
    std::this_thread::sleep_for(kTakenAfter);
    if (client.health().refused_commands != refused)
      throw text::LimitNotMet(fmt::format("the board refuses the command {} in mode {}", arguments.what,
                                          name_of(client.newest().mode)));
  }
  const upload::BoardTick tick = client.newest();
  fmt::print(human_stream(arguments.json), "mode {}{}, fault {}\n", name_of(tick.mode),
             tick.holding ? " (held)" : "", name_of(tick.fault));
  write_json(arguments.json, {{"board", client.info().board},
                              {"mode", name_of(tick.mode)},
                              {"fault", name_of(tick.fault)},
                              {"holding", tick.holding}});
}

}  // namespace

void register_board(CLI::App& vernier) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = vernier.add_subcommand(
      "board", "Control a board: activate, deactivate, clear, hold, release, weight, identify");
  command
      ->add_option("WHAT", arguments->what,
                   "activate | deactivate | clear (a latched fault) | hold | release | weight | identify")
      ->required()
      ->check(CLI::IsMember({"activate", "deactivate", "clear", "hold", "release", "weight", "identify"}));
  command->add_option("--to", arguments->url, "board: tcp://HOST[:1502], rtu://DEVICE, can://INTERFACE")
      ->required();
  command
      ->add_option("--key", arguments->key,
                   "secret key of `vernier keys` (or VERNIER_KEY); required if the board has keys")
      ->type_name(kReads);
  add_board_claim(*command, arguments->claim);
  command->add_option("--axis", arguments->axis, "axis of a weight");
  command
      ->add_option("--weight", arguments->weight,
                   "share of the axis' correction that the board applies, 0 to 1")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "Exit status: 0 done, 1 bad input or no board, 2 the board refused the request, or another board "
      "answered (nothing was sent).");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace vernier::commands::board_cli
