// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <thread>

#include "tools/commands/command.h"
#include "tools/format/columns.h"
#include "tools/text/error.h"
#include "tools/upload/client.h"
#include "tools/upload/open_transport.h"

namespace vernier::commands::touches_cli {
namespace {

struct Arguments {
  std::string url, output, key, json, run;
  double seconds = 0;
  std::uint64_t first = 0, count = std::numeric_limits<std::uint64_t>::max();
  double x = 0, y = 0, z = 0, angle = 0;
  bool frame = false;
};

struct Lost {
  std::uint64_t overwritten = 0, without_position = 0;
  upload::TouchTotals board;
};

const char* unit_of(const upload::BoardSignal& axis) { return axis.rotary ? "deg" : "mm"; }

// Columns of FORMATS section 2: axes as read, the tool point in workpiece coordinates, compensated axes
// beside them.
std::string header(const upload::BoardInfo& info) {
  std::string text = "touch," + format::heading(format::columns::kTime);
  for (const upload::BoardSignal& axis : info.axes) text += fmt::format(",{}[{}]", axis.name, unit_of(axis));
  for (const upload::BoardSignal& axis : info.axes)
    text += fmt::format(",compensated{}[{}]", axis.name, unit_of(axis));
  return text + "," + format::headings(format::columns::kPoint) + "," +
         format::heading(format::columns::kUncertainty) + ",bounces," + format::columns::kRun + "\n";
}

void append(std::string& text, const upload::BoardInfo& info, const upload::BoardTouch& touch,
            const std::string& run) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{},{:.9f}", touch.number, touch.time_s);
  for (const double position : touch.position) fmt::format_to(out, ",{:.10g}", position);
  for (const double position : touch.compensated) fmt::format_to(out, ",{:.10g}", position);
  for (int i = 0; i < 3; ++i)
    touch.workpiece ? fmt::format_to(out, ",{:.10g}", (*touch.workpiece)[static_cast<std::size_t>(i)])
                    : fmt::format_to(out, ",");
  double u = 0;
  for (std::size_t i = 0; i < info.axes.size(); ++i)
    if (!info.axes[i].rotary) u = std::max(u, touch.uncertainty[i]);
  fmt::format_to(out, ",{:.3g},{},{}\n", u, touch.bounces, run);
}

std::string in_words(const Lost& lost) {
  std::string text;
  const auto say = [&](std::uint64_t number, const char* what) {
    if (number > 0) text += fmt::format("; {} {}", number, what);
  };
  say(lost.overwritten, "touches were overwritten before they were read");
  say(lost.without_position, "touches have no position (an edge or samples near it were lost)");
  say(lost.board.lost_edges, "times edges of the probe signal were lost between the probe and the board");
  say(lost.board.lost_touches, "touches came faster than the board could publish them");
  say(lost.board.missing, "edges are missing from the line");
  say(lost.board.spikes, "spikes were no touches");
  return text;
}

void run(const Arguments& arguments) {
  upload::Client client(upload::open_transport(upload::parse_url(arguments.url)));
  client.sign_with(upload::given_key(arguments.key));
  if (arguments.frame) {
    client.workpiece({arguments.x, arguments.y, arguments.z}, arguments.angle);
    if (arguments.output.empty()) {
      fmt::print(human_stream(arguments.json), "workpiece at X {} Y {} Z {} mm, turned {} deg\n", arguments.x,
                 arguments.y, arguments.z, arguments.angle);
      write_json(arguments.json,
                 {{"origin_mm", {arguments.x, arguments.y, arguments.z}}, {"angle_deg", arguments.angle}});
      return;
    }
  }
  if (arguments.output.empty())
    throw text::InputError("no output is requested: give -o FILE, or --origin-x/y/z and --angle");
  Progress progress("touches");
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  std::string text = header(client.info());
  std::uint64_t next = arguments.first, rows = 0;
  Lost lost;
  for (;;) {
    const upload::BoardTouches touches = client.touches(next);
    lost.overwritten += touches.lost;
    next = touches.next;
    for (const upload::BoardTouch& touch : touches.touches) {
      lost.board = touch.totals;
      if (rows >= arguments.count) break;
      if (!touch.has_position) {
        ++lost.without_position;
        continue;
      }
      append(text, client.info(), touch, arguments.run);
      ++rows;
    }
    const double passed = std::chrono::duration<double>(Clock::now() - start).count();
    if (rows >= arguments.count || (touches.touches.empty() && passed >= arguments.seconds)) break;
    if (!touches.touches.empty()) continue;
    progress.update(passed / arguments.seconds);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  text::write_file(arguments.output, text);
  fmt::print(human_stream(arguments.json), "{}: {} touches{}\n", arguments.output, rows, in_words(lost));
  write_json(arguments.json, {{"touches", rows},
                              {"next", next},
                              {"overwritten", lost.overwritten},
                              {"without_position", lost.without_position},
                              {"lost_edges", lost.board.lost_edges},
                              {"lost_touches", lost.board.lost_touches},
                              {"missing_edges", lost.board.missing},
                              {"spikes", lost.board.spikes}});
}

}  // namespace

void register_touches(CLI::App& vernier) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command =
      vernier.add_subcommand("touches",
                             "Read the touches of a board's probe as CSV: axis positions at the contact, "
                             "corrected, in machine and workpiece coordinates");
  command->add_option("--to", arguments->url, "board: tcp://HOST[:1502], rtu://DEVICE, can://INTERFACE")
      ->required();
  command
      ->add_option("--key", arguments->key,
                   "secret key of `vernier keys` (or VERNIER_KEY); required to set the workpiece position on "
                   "a board that has keys")
      ->type_name(kReads);
  command->add_option("-o", arguments->output, "CSV file")->type_name(kWrites);
  command->add_option("--first", arguments->first, "number of the first touch")->capture_default_str();
  command->add_option("--count", arguments->count, "stop after this number of touches");
  command->add_option("--seconds", arguments->seconds, "time to wait for further touches, s")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  command->add_option("--run", arguments->run, "label of the run column")->default_val("probe");
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  const char* const kFrame = "Workpiece";
  const auto frame = [&](const char* name, double& value, const char* what) {
    command->add_option(name, value, what)->group(kFrame)->each([arguments](const std::string&) {
      arguments->frame = true;
    });
  };
  frame("--origin-x", arguments->x,
        "send the position of the workpiece to the board, in machine coordinates, mm");
  frame("--origin-y", arguments->y, "the same");
  frame("--origin-z", arguments->z, "the same");
  frame("--angle", arguments->angle,
        "angle about Z from the X direction of the machine to the X direction of the workpiece, deg");
  command->footer(
      "Touches are numbered from the power-on of the board. The result lists touches that the board no "
      "longer has.\n"
      "Exit status: 0 done, 1 bad input or no board.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace vernier::commands::touches_cli
