// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "tools/commands/command.h"
#include "tools/commands/model/plan_kinds.h"
#include "tools/model/machine_reader.h"
#include "tools/plan/standard/positioning_test.h"
#include "tools/text/files.h"

namespace vernier::commands::plan_cli {

void run_positioning_plan(const PlanArguments& arguments) {
  const model::Machine machine = model::parse_machine(text::read_file(arguments.machine), arguments.machine);
  plan::PositioningTestOptions options = arguments.positioning;
  options.targets = arguments.points;
  options.at = arguments.part.at;
  options.feed = arguments.feed_mm_min;
  options.dwell_s = arguments.dwell_s;
  const plan::PositioningTest test = plan::positioning_test(machine, options);
  nlohmann::ordered_json json = {{"machine", machine.name},
                                 {"axis", options.axis},
                                 {"unit", test.rotary ? "deg" : "mm"},
                                 {"targets", test.targets},
                                 {"interval", test.interval},
                                 {"runs", test.runs},
                                 {"overrun", test.overrun},
                                 {"readings", 2 * test.runs * test.targets.size()},
                                 {"reading_column", test.reading},
                                 {"at", nlohmann::ordered_json::object()},
                                 {"minutes", test.minutes}};
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    if (i != test.axis) json["at"][machine.axes[i].name] = test.rest[i];
  if (!arguments.output.empty())
    text::write_file(arguments.output, plan::positioning_test_csv(machine, test));
  if (!arguments.gcode.empty())
    text::write_file(arguments.gcode, plan::positioning_test_gcode(machine, test));
  write_json(arguments.json, json);
  fmt::print(human_stream(arguments.json), "{}", plan::positioning_test_text(machine, test));
}

}  // namespace vernier::commands::plan_cli
