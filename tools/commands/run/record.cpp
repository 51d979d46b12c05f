// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <iterator>
#include <optional>
#include <thread>

#include "tools/commands/command.h"
#include "tools/commands/until_told.h"
#include "tools/format/columns.h"
#include "tools/model/machine.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"
#include "tools/upload/client.h"
#include "tools/upload/open_transport.h"

namespace vernier::commands::record_cli {
namespace {

struct Arguments {
  std::string url, output, json, run, machine;
  double seconds = 10;
  int every = 10;
};

/// The unit of an input as the machine file declares it, in brackets: the board knows the number only.
std::string unit_of(const std::string& input, const std::optional<model::Machine>& machine) {
  const auto found = machine ? machine->find_input(input) : std::nullopt;
  if (!found || machine->inputs[*found].unit.empty()) return "";
  return "[" + machine->inputs[*found].unit + "]";
}

// Columns of FORMATS section 2; the measured tool point is added later by the user.
std::string header(const upload::BoardInfo& info, const std::optional<model::Machine>& machine) {
  using format::AxisQuantity;
  std::string text = format::heading(format::columns::kTime);
  for (const upload::BoardSignal& axis : info.axes)
    text += "," + format::axis_heading(AxisQuantity::kPosition, axis.name, axis.rotary);
  for (const upload::BoardSignal& axis : info.axes)
    text += "," + format::axis_heading(AxisQuantity::kSense, axis.name, axis.rotary);
  text += "," + format::heading(format::columns::kFeed);
  for (const std::string& input : info.inputs) text += "," + input + unit_of(input, machine);
  for (const upload::BoardSignal& axis : info.axes)
    text += "," + format::axis_heading(AxisQuantity::kCorrection, axis.name, axis.rotary);
  return text + "," + format::columns::kRun + "\n";
}

void append(std::string& text, const upload::BoardTick& tick, const std::string& run) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{:.6f}", tick.time_s);
  for (const double position : tick.position) fmt::format_to(out, ",{:.9g}", position);
  for (const int sense : tick.sense) fmt::format_to(out, ",{}", sense);
  fmt::format_to(out, ",{:.9g}", tick.feed_mm_per_min);
  for (const double input : tick.input) fmt::format_to(out, ",{:.9g}", input);
  for (const double correction : tick.correction) fmt::format_to(out, ",{:.9g}", correction);
  fmt::format_to(out, ",{}\n", run);
}

/// Records until the time is over or `stop` is set.
void record(const Arguments& arguments, const std::atomic<bool>& stop) {
  using Clock = std::chrono::steady_clock;
  std::optional<model::Machine> machine;
  if (!arguments.machine.empty()) machine = model::read_machine(arguments.machine);
  upload::Client client(upload::open_transport(upload::parse_url(arguments.url)));
  Progress progress("record");
  std::string text = header(client.info(), machine);
  std::uint64_t rows = 0, lost = 0;
  const double tick_s = client.info().hello.tick_us * 1e-6;
  std::uint64_t next = client.newest().number;
  const auto end = next + static_cast<std::uint64_t>(arguments.seconds / tick_s);
  const auto start = Clock::now();
  while (next < end && !stop) {
    const upload::BoardHistory history = client.history(next, static_cast<std::uint16_t>(arguments.every));
    lost += history.lost;
    for (const upload::BoardTick& tick : history.ticks) {
      if (tick.number >= end) break;
      append(text, tick, arguments.run);
      ++rows;
    }
    next = history.next;
    progress.update(std::chrono::duration<double>(Clock::now() - start).count() / arguments.seconds);
    if (history.ticks.empty())
      std::this_thread::sleep_for(std::chrono::duration<double>(arguments.every * tick_s));
  }
  text::write_file(arguments.output, text);
  fmt::print(human_stream(arguments.json), "{}: {} rows{}\n", arguments.output, rows,
             lost > 0 ? fmt::format("; {} ticks were overwritten before the line could transmit them: record "
                                    "fewer ticks (--every)",
                                    lost)
                      : "");
  write_json(arguments.json, {{"rows", rows}, {"lost_ticks", lost}, {"every", arguments.every}});
}

}  // namespace

void register_record(CLI::App& vernier) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command =
      vernier.add_subcommand("record",
                             "Record positions, directions, inputs and corrections of a running board as a "
                             "measurement file (CSV) without readings");
  command->add_option("--to", arguments->url, "board: tcp://HOST[:1502], rtu://DEVICE, can://INTERFACE")
      ->required();
  command->add_option("-o", arguments->output, "CSV file")->type_name(kWrites)->required();
  command->add_option("--seconds", arguments->seconds, "length of the recording")
      ->check(CLI::Range(0.01, 1e6))
      ->capture_default_str();
  command->add_option("--every", arguments->every, "number of ticks per row")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  command
      ->add_option("--machine", arguments->machine,
                   "machine file (XML) with the units of the inputs; without it these columns have no units")
      ->type_name(kReads);
  command->add_option("--run", arguments->run, "label of the run column")->default_val("record");
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "Ctrl-C (SIGINT) or SIGTERM ends the recording before its time; the file then has the rows until the "
      "signal.\n"
      "Exit status 0 done, 1 bad input, 2 the board did not answer within a second of the signal (nothing "
      "written).");
  command->callback([arguments] {
    constexpr int kBoardIsSilent = 2;
    until_told([&](const std::atomic<bool>& stop) { record(*arguments, stop); }, [] {}, kBoardIsSilent);
  });
}

}  // namespace vernier::commands::record_cli
