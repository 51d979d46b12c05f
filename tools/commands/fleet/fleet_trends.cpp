// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "tools/commands/command.h"
#include "tools/commands/fleet/fleet_kinds.h"
#include "tools/registry/alike.h"
#include "tools/registry/due.h"
#include "tools/text/error.h"
#include "tools/text/optional_json.h"
#include "tools/text/wall_time.h"

namespace vernier::commands::fleet_cli {
namespace {

using Json = nlohmann::ordered_json;

struct TrendArguments {
  std::string registry, json, at, since;
  registry::AlikeOptions alike;
};

void run_due(const TrendArguments& arguments) {
  registry::Registry registry = open_registry(arguments.registry);
  Json all = Json::array();
  std::FILE* const out = human_stream(arguments.json);
  std::size_t due = 0;
  for (const registry::DueMachine& one :
       registry::due_machines(registry, time_of(arguments.at, text::now_us()))) {
    const auto text = [](const std::optional<std::int64_t>& time) {
      return time ? Json(text::utc_text(*time)) : Json(nullptr);
    };
    all.push_back({{"machine", one.machine},
                   {"due", !one.why.empty()},
                   {"why", one.why},
                   {"due_at", text(one.due_us)},
                   {"checked_at", text(one.last_us)},
                   {"verdict", one.verdict}});
    if (one.why.empty()) continue;
    ++due;
    fmt::print(out, "{:<20} {:<45} {}\n", one.machine, one.why,
               one.last_us ? "last check " + text::utc_text(*one.last_us) : "");
  }
  fmt::print(out, "{} of {} machines due for a check\n", due, all.size());
  write_json(arguments.json, {{"machines", all}});
}

Json drift_json(const registry::Drift& drift) {
  Json json = {
      {"quantity", drift.quantity}, {"unit", drift.unit},         {"judged", drift.judged},
      {"machines", drift.machines}, {"times", drift.times},       {"readings", drift.readings},
      {"common", drift.common},     {"common_p", drift.common_p}, {"common_swing", drift.common_swing},
      {"scatter", drift.scatter},   {"wander", drift.wander},     {"wander_days", drift.wander_days}};
  json["curve"] = Json::array();
  for (const auto& [at, value] : drift.curve)
    json["curve"].push_back({{"at", text::utc_text(at)}, {"value", value}});
  json["own"] = Json::array();
  for (const registry::OwnDrift& one : drift.own)
    json["own"].push_back({{"machine", one.machine}, {"per_day", one.per_day}, {"std", one.std}});
  return json;
}

void run_alike(const TrendArguments& arguments) {
  registry::Registry registry = open_registry(arguments.registry);
  Json all = Json::array();
  std::FILE* const out = human_stream(arguments.json);
  for (const registry::Drift& drift :
       registry::drifts(registry.readings(time_of(arguments.since, 0)), arguments.alike)) {
    all.push_back(drift_json(drift));
    if (!drift.judged) {
      fmt::print(out, "{}: too few readings for a result ({} machines, {} times)\n", drift.quantity,
                 drift.machines, drift.times);
      continue;
    }
    if (drift.common)
      fmt::print(out, "{}: {} machines have the same change, {:.3g} {} (p {:.1e}): look for a common cause\n",
                 drift.quantity, drift.machines - drift.own.size(), drift.common_swing, drift.unit,
                 drift.common_p);
    for (const registry::OwnDrift& one : drift.own)
      fmt::print(out, "{}: {} drifts by itself, {:.3g} \u00b1 {:.2g} {} a day\n", drift.quantity, one.machine,
                 one.per_day, one.std, drift.unit);
    if (!drift.common && drift.own.empty())
      fmt::print(out, "{}: no drift ({} machines, {} times, scatter {:.2g} times the stated uncertainty)\n",
                 drift.quantity, drift.machines, drift.times, drift.scatter);
    if (drift.wander > 0)
      fmt::print(
          out,
          "{}: individual wander of the machines: {:.2g} of the stated uncertainty, over about {:.3g} days\n",
          drift.quantity, drift.wander, drift.wander_days);
  }
  if (all.empty())
    fmt::print(out, "the registry has no readings: enter them with `vernier fleet check --history`\n");
  write_json(arguments.json, {{"quantities", all}, {"false_alarms", arguments.alike.false_alarms}});
}

}  // namespace

void add_trends(CLI::App& fleet) {
  const auto due = std::make_shared<TrendArguments>();
  CLI::App* command =
      fleet.add_subcommand("due", "list the machines that are due for a check, with the reason");
  add_registry(*command, due->registry);
  command->add_option("--at", due->at, "time at which the checks are due (UTC); default: now");
  command->add_option("--json", due->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->callback([due] { run_due(*due); });

  const auto alike = std::make_shared<TrendArguments>();
  command = fleet.add_subcommand("alike",
                                 "find parameter changes that several machines have in common (a common "
                                 "cause), and changes of a single machine");
  add_registry(*command, alike->registry);
  command->add_option(
      "--since", alike->since,
      "start of the evaluated time (UTC): earlier readings are ignored; default: all readings");
  command
      ->add_option("--every", alike->alike.every_days,
                   "number of days whose readings count as readings of one time")
      ->check(CLI::Range(0.001, 3660.0))
      ->capture_default_str();
  command
      ->add_option("--false-alarms", alike->alike.false_alarms,
                   "probability of reporting any drift if no machine drifts")
      ->check(CLI::Range(1e-9, 0.5))
      ->capture_default_str();
  command->add_option("--json", alike->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "Model: reading = constant of the machine + common curve of time + rate of the machine x time, "
      "weighted by the stated\n"
      "uncertainties. The command adds the rates of single machines one by one if an F test is significant, "
      "and treats the\n"
      "readings as independent and normally distributed. Exit status 0 done (for every result), 1 bad "
      "input.");
  command->callback([alike] { run_alike(*alike); });
}

}  // namespace vernier::commands::fleet_cli
