// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/commands/model/plan_kinds.h"
#include "tools/kinematics/at.h"
#include "tools/plan/accuracy/accuracy_plan.h"
#include "tools/plan/sheets.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::commands::plan_cli {
namespace {

using Json = nlohmann::ordered_json;

/// "X=100:200,Y=0:50"
std::vector<model::WorkRange> region_of(const model::Machine& machine, const std::string& words) {
  std::vector<model::WorkRange> region;
  for (const std::string& word : text::words_in(words, ", ")) {
    const auto equals = word.find('='), colon = word.find(':');
    const auto axis = machine.find_axis(word.substr(0, equals));
    if (!axis)
      throw text::InputError({"--region", 0}, word,
                             fmt::format("this name is not an axis of {}", machine.name));
    const auto low = colon == std::string::npos || equals == std::string::npos
                         ? std::nullopt
                         : text::parse_number(word.substr(equals + 1, colon - equals - 1));
    const auto high = low ? text::parse_number(word.substr(colon + 1)) : std::nullopt;
    if (!high || !(*low < *high)) throw text::InputError({"--region", 0}, word, "a range is AXIS=LOW:HIGH");
    if (const auto range = model::work_range(machine, *axis);
        range && (*low < (*range)[0] || *high > (*range)[1]))
      throw text::InputError(
          {"--region", 0}, word,
          fmt::format("the region is outside the range of the axis, {:g} to {:g}", (*range)[0], (*range)[1]));
    region.push_back({*axis, *low, *high});
  }
  return region;
}

plan::Knowledge knowledge_from(const PlanArguments& arguments, const model::Machine& machine) {
  if (arguments.measurements.empty()) return plan::knowledge_of(machine);
  const model::Measurement rows = rows_of_plan(arguments, machine);
  const fit::FitResult fitted = fit::fit(machine, rows);
  if (!fitted.absurd.empty()) throw text::LimitNotMet(fitted.absurd);
  if (!fitted.converged) throw text::LimitNotMet("the fit of the measured rows did not converge");
  return plan::knowledge_of(fitted, rows);
}

Json limits_json(const std::vector<plan::AccuracyLimit>& limits) {
  Json list = Json::array();
  for (const plan::AccuracyLimit& one : limits) list.push_back({{"name", one.name}, {"share", one.share}});
  return list;
}

Json accuracy_json(const plan::Knowledge& knowledge, const plan::AccuracyAim& aim,
                   const plan::AccuracyPlan& plan, const PlanArguments& arguments) {
  Json json = {{"machine", knowledge.machine.name},
               {"aim", aim.words},
               {"asked_um", arguments.accuracy_um > 0 ? Json(arguments.accuracy_um) : Json(nullptr)},
               {"reached", plan.reached},
               {"reading_um", 1000 * knowledge.reading_mm},
               {"new_set_up", knowledge.new_set_up},
               {"u95_now_um", plan.now_um},
               {"u95_um", plan.after_um},
               {"u95_random_um", plan.random_um},
               {"u95_floor_um", plan.floor_um},
               {"points", plan.states.count},
               {"minutes", plan.steps.back().minutes},
               {"table", Json::array()},
               {"features", Json::array()},
               {"limited_by", limits_json(plan.limits)},
               {"not_seen", limits_json(plan.unseen)},
               {"rows", Json::array()}};
  for (const plan::AccuracyStep& step : plan.steps)
    json["table"].push_back({{"points", step.points}, {"minutes", step.minutes}, {"u95_um", step.u95_um}});
  for (const plan::AccuracyOf& one : plan.parts)
    json["features"].push_back({{"name", one.name}, {"u95_now_um", one.now_um}, {"u95_um", one.after_um}});
  for (std::size_t row = 0; row < plan.states.count; ++row)
    json["rows"].push_back(pose_json(knowledge.machine, plan.states, row));
  return json;
}

std::string named(const std::vector<plan::AccuracyLimit>& limits) {
  constexpr std::size_t kMost = 4;
  std::string text;
  for (std::size_t i = 0; i < limits.size() && i < kMost; ++i)
    text += fmt::format("{}{} ({:.0f} %)", i > 0 ? ", " : "", limits[i].name, 100 * limits[i].share);
  return text;
}

/// Why it cannot be reached, in one line.
std::string why_not(const plan::AccuracyPlan& plan, double asked_um) {
  if (plan.floor_um > asked_um)
    return fmt::format(
        "U95 of {:g} um cannot be reached: no number of such readings reduces U95 below {:.3g} um, because "
        "the readings do not determine {}",
        asked_um, plan.floor_um, named(plan.unseen));
  return fmt::format(
      "U95 of {:g} um is not reached: {} poses give {:.3g} um, limited by {}; give more --points, or use "
      "readings with a smaller uncertainty",
      asked_um, plan.states.count, plan.after_um, named(plan.limits));
}

void print_accuracy(std::FILE* out, const plan::AccuracyAim& aim, const plan::AccuracyPlan& plan,
                    double asked_um) {
  if (plan.states.count == 0) {
    fmt::print(out, "U95 over {} is already {:.3g} um{}: no further measurement is needed\n", aim.words,
               plan.now_um, asked_um > 0 ? fmt::format(", {:g} asked", asked_um) : "");
    return;
  }
  fmt::print(out, "U95 (k = 2) over {}:\n{:>8} {:>9} {:>10}\n", aim.words, "points", "minutes", "U95 um");
  for (const plan::AccuracyStep& step : plan.steps)
    fmt::print(out, "{:>8} {:>9.1f} {:>10.3g}\n", step.points, step.minutes, step.u95_um);
  fmt::print(out,
             "the same number of random poses gives {:.3g} um; any number of such readings gives at least "
             "{:.3g} um\n",
             plan.random_um, plan.floor_um);
  for (const plan::AccuracyOf& one : plan.parts)
    fmt::print(out, "  {:<36} {:>8.3g} -> {:.3g} um\n", one.name, one.now_um, one.after_um);
  if (!plan.limits.empty()) fmt::print(out, "the remaining uncertainty comes from {}\n", named(plan.limits));
}

}  // namespace

void run_accuracy_plan(const PlanArguments& arguments) {
  if (!(arguments.accuracy_um > 0) && arguments.points == 0)
    throw text::InputError(
        {}, "--accuracy",
        "U95 that the plan must reach (or --points), or --separate A,B: two effects to distinguish");
  if (!arguments.part.path.empty() && !arguments.region.empty())
    throw text::InputError({}, "--region", "give either --part or --region, not both");
  const model::Machine machine = read_model(arguments.machine);
  plan::AccuracyAim aim;
  aim.words = machine.volume.empty() ? "the axes' ranges" : "the volume";
  if (!arguments.region.empty()) {
    aim.region = region_of(machine, arguments.region);
    aim.words = "the region " + arguments.region;
  }
  plan::Knowledge knowledge = knowledge_from(arguments, machine);
  if (!arguments.tool.empty()) aim.tooled = kinematics::tooled(knowledge.machine, arguments.tool);
  if (!arguments.part.path.empty()) {
    aim.part = part_cli::placed_part(arguments.part, aim.tooled.value_or(knowledge.machine));
    aim.words = "the features of " + arguments.part.path;
  }
  if (arguments.reading_um) knowledge.reading_mm = 1e-3 * *arguments.reading_um;
  plan::AccuracyOptions options;
  options.accuracy_um = arguments.accuracy_um;
  if (arguments.points > 0) options.most = arguments.points;
  options.feed_mm_min = arguments.feed_mm_min;
  options.reading_s = arguments.dwell_s;
  Progress progress("plan");
  options.progress = [&](double share) { progress.update(share); };
  const plan::AccuracyPlan plan = plan::accuracy_plan(knowledge, aim, options);
  if (!plan.reached) throw text::LimitNotMet(why_not(plan, arguments.accuracy_um));
  if (!arguments.output.empty() && plan.states.count > 0)
    text::write_file(arguments.output, plan::accuracy_plan_csv(knowledge, plan));
  if (!arguments.gcode.empty() && plan.states.count > 0)
    text::write_file(arguments.gcode, plan::poses_gcode(knowledge.machine, plan.states,
                                                        "measurement for accuracy of " + machine.name));
  write_json(arguments.json, accuracy_json(knowledge, aim, plan, arguments));
  print_accuracy(human_stream(arguments.json), aim, plan, arguments.accuracy_um);
  if (knowledge.new_set_up && plan.states.count > 0)
    fmt::print(
        human_stream(arguments.json),
        "planned as a separate set-up: the machine file needs <BaseShift run=\"{}\"/> to fit these rows\n",
        plan::kAccuracyRun);
}

}  // namespace vernier::commands::plan_cli
