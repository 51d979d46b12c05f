// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "tools/commands/command.h"
#include "tools/upload/live.h"
#include "tools/upload/open_transport.h"

namespace vernier::commands::watch_cli {
namespace {

struct Arguments {
  std::string url, json;
  double rate = 10, seconds = 0;
};

struct Live {
  upload::BoardTick tick;
  HealthRecord health;
  SlotsReply slots;
  std::vector<upload::BoardShare> shares;
  upload::BoardState state;
};

Live look(upload::Client& client) {
  return {client.newest(), client.health(), client.slots(), client.shares(), client.state()};
}

void status(const Arguments& arguments) {
  upload::Client client(upload::open_transport(upload::parse_url(arguments.url)));
  const Live live = look(client);
  fmt::print(human_stream(arguments.json), "{}",
             upload::live_text(client.info(), live.tick, live.health, live.slots, live.shares, live.state));
  write_json(arguments.json,
             upload::live_json(client.info(), live.tick, live.health, live.slots, live.shares, live.state));
}

// On a terminal the picture is drawn over the one before; into a pipe or file, one block after the other.
void draw(const std::string& text, bool terminal, std::ptrdiff_t& lines_before) {
  if (terminal && lines_before > 0) fmt::print("\033[{}F\033[J", lines_before);
  fmt::print("{}", text);
  if (!terminal) fmt::print("\n");
  std::fflush(stdout);
  lines_before = std::count(text.begin(), text.end(), '\n');
}

void watch(const Arguments& arguments) {
  using Clock = std::chrono::steady_clock;
  upload::Client client(upload::open_transport(upload::parse_url(arguments.url)));
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  const auto start = Clock::now();
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / arguments.rate));
  std::ptrdiff_t lines = 0;
  for (auto due = start;
       arguments.seconds == 0 || due - start < std::chrono::duration<double>(arguments.seconds);
       due += period) {
    std::this_thread::sleep_until(due);
    const Live live = look(client);
    if (arguments.json.empty()) {
      draw(upload::live_text(client.info(), live.tick, live.health, live.slots, live.shares, live.state),
           terminal, lines);
    } else {
      fmt::print("{}\n",
                 upload::live_json(client.info(), live.tick, live.health, live.slots, live.shares, live.state)
                     .dump());
      std::fflush(stdout);
    }
    due = std::max(due, Clock::now() - period);  // a slow line gets fewer pictures, not a backlog
  }
}

void add_board(CLI::App* command, const std::shared_ptr<Arguments>& arguments) {
  command->add_option("--to", arguments->url, "board: tcp://HOST[:1502], rtu://DEVICE, can://INTERFACE")
      ->required();
}

}  // namespace

void register_status(CLI::App& vernier) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = vernier.add_subcommand(
      "status", "Print the present state of a board: mode, axes, counters, correction image");
  add_board(command, arguments);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->callback([arguments] { status(*arguments); });
}

void register_watch(CLI::App& vernier) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command =
      vernier.add_subcommand("watch", "Show the state of a running board until interrupted");
  add_board(command, arguments);
  command->add_option("--rate", arguments->rate, "pictures a second")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  command->add_option("--seconds", arguments->seconds, "stop after this time, s (0: never)")
      ->check(CLI::Range(0.0, 1e9));
  command
      ->add_option("--json", arguments->json,
                   "output file for programs; - writes one JSON object per line to standard output")
      ->check(CLI::IsMember({"-"}));
  command->callback([arguments] { watch(*arguments); });
}

}  // namespace vernier::commands::watch_cli
