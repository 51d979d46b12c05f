// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/commands/model/plan_kinds.h"
#include "tools/effects/catalogue.h"
#include "tools/fit/files/file_noise.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"
#include "tools/plan/check_plan.h"
#include "tools/plan/first_plan.h"
#include "tools/plan/plan.h"
#include "tools/plan/sheets.h"
#include "tools/plan/touch_plan.h"
#include "tools/simulate/corrected.h"
#include "tools/text/files.h"
#include "tools/text/words.h"

namespace vernier::commands::plan_cli {
namespace {

using Json = nlohmann::ordered_json;

Json row_json(const plan::Plan& plan, std::size_t row) {
  const auto at = static_cast<Eigen::Index>(row);
  const model::States& s = plan.rows.states;
  Json json;
  for (std::size_t a = 0; a < plan.machine.axes.size(); ++a) {
    const std::string& name = plan.machine.axes[a].name;
    json["axes"][name] = s.axis[a][at];
    json["dir"][name] = s.direction[a][at];
    json["v"][name] = s.velocity[a][at];
    if (s.since[a][at] < model::kLongWay) json["since"][name] = s.since[a][at];
  }
  json["feed"] = s.feed[at];
  json["t"] = s.time[at];
  json["inputs"] = Json::object();
  for (std::size_t i = 0; i < plan.machine.inputs.size(); ++i)
    json["inputs"][plan.machine.inputs[i].name] = s.input[i][at];
  const plan::Drivers drivers =
      plan::drivers_of(std::vector<const plan::FittedHypothesis*>{&plan.a, &plan.b});
  for (const model::CandidateInput& candidate : plan.rows.candidates)
    if (drivers.inputs.contains(candidate.name)) json["inputs"][candidate.name] = candidate.value[at];
  return json;
}

Json plan_json(const plan::Plan& plan, double confidence) {
  const auto side = [](const plan::Separation& s) -> Json {
    return {{"now", s.now}, {"planned", s.planned}, {"needed", s.needed}};
  };
  const plan::Separation& worse = plan.worse();
  Json json;
  json["separate"] = {{{"effect", plan.a.candidate.choice.effect->id}, {"add", plan.a.add}},
                      {{"effect", plan.b.candidate.choice.effect->id}, {"add", plan.b.add}}};
  json["non_centrality_now"] = worse.now;
  json["non_centrality_planned"] = plan.rows.rows() == 0 ? worse.now : worse.planned;
  json["non_centrality_needed"] = worse.needed;
  json["first_true"] = side(plan.a_true);
  json["second_true"] = side(plan.b_true);
  json["confidence"] = confidence;
  json["separable"] = plan.separable || plan.told_already;
  json["lead_of_first"] = plan.lead_of_a;
  json["told_already"] = plan.told_already;
  json["points"] = plan.rows.rows();
  json["rows"] = Json::array();
  for (std::size_t row = 0; row < plan.rows.rows(); ++row) json["rows"].push_back(row_json(plan, row));
  json["not_settable"] = plan.not_settable;
  json["ruled_out"] = plan.ruled_out;
  json["not_ruled_out"] = plan.not_ruled_out;
  json["sentence"] = plan.sentence;
  return json;
}

Json poses_json(const model::Machine& machine, const model::States& states) {
  Json rows = Json::array();
  for (std::size_t row = 0; row < states.count; ++row) rows.push_back(pose_json(machine, states, row));
  return rows;
}

/// A short measurement that sees the likeliest changes.
void run_check_plan(const PlanArguments& arguments) {
  const model::Machine machine = read_model(arguments.machine);
  plan::CheckPlanOptions options;
  options.reading_um = arguments.reading_um.value_or(options.reading_um);
  if (arguments.expected_um > 0) options.expected_um = arguments.expected_um;
  if (arguments.points > 0) options.points = arguments.points;
  const plan::CheckPlan plan = plan::check_plan(machine, options);
  Json json = {{"machine", machine.name},   {"points", plan.states.count},      {"shows", Json::array()},
               {"not_seen", plan.not_seen}, {"tool_random_um", plan.random_um}, {"rows", Json::array()}};
  for (const plan::Shown& one : plan.shows)
    json["shows"].push_back({{"name", one.quantity.name},
                             {"change", one.change},
                             {"unit", one.quantity.unit},
                             {"tool_um", one.tool_um}});
  json["rows"] = poses_json(machine, plan.states);
  const double worst = plan.shows.empty() ? 0 : plan.shows.front().tool_um;
  if (arguments.accuracy_um > 0 && (worst > arguments.accuracy_um || plan.shows.empty()))
    throw text::LimitNotMet(
        fmt::format("{} poses show {} only if its change moves the tool by {:.3g} um: give more "
                    "--points, or use readings with a standard uncertainty below {:g} um",
                    plan.states.count, plan.shows.empty() ? "nothing" : plan.shows.front().quantity.name,
                    worst, options.reading_um));
  if (!arguments.output.empty())
    text::write_file(arguments.output, plan::check_plan_csv(machine, plan, options.reading_um));
  if (!arguments.gcode.empty())
    text::write_file(arguments.gcode, plan::poses_gcode(machine, plan.states, "check of " + machine.name));
  write_json(arguments.json, json);
  fmt::print(human_stream(arguments.json), "{}", plan::check_plan_text(plan, options.reading_um));
}

/// Which touches of an artefact determine the machine, and what none of them can.
void run_touch_plan(const PlanArguments& arguments) {
  const model::Machine machine = model::parse_machine(text::read_file(arguments.machine), arguments.machine);
  plan::TouchPlanOptions options;
  options.reading_um = arguments.reading_um.value_or(options.reading_um);
  if (arguments.expected_um > 0) options.expected_um = arguments.expected_um;
  if (arguments.points > 0) options.points = arguments.points;
  const plan::TouchPlan plan = plan::touch_plan(machine, arguments.artefact, options);
  if (arguments.accuracy_um > 0 && plan.after_um > arguments.accuracy_um)
    throw text::LimitNotMet(fmt::format(
        "U95 of {:g} um cannot be reached: {} touches of the artefact {} give {:.3g} um, and all considered "
        "touches together give {:.3g} um",
        arguments.accuracy_um, plan.states.count, arguments.artefact, plan.after_um, plan.least_um));
  Json json = {{"machine", machine.name},
               {"artefact", arguments.artefact},
               {"points", plan.states.count},
               {"u95_before_um", plan.before_um},
               {"u95_um", plan.after_um},
               {"u95_least_um", plan.least_um},
               {"place_mm", std::vector<double>(plan.place_mm.data(), plan.place_mm.data() + 3)},
               {"place_is_assumed", plan.place_is_assumed},
               {"size_known", plan.has_length},
               {"not_seen", plan.not_seen},
               {"rows", Json::array()}};
  json["rows"] = poses_json(machine, plan.states);
  if (!arguments.output.empty())
    text::write_file(arguments.output,
                     plan::touch_plan_csv(machine, plan, arguments.artefact, options.reading_um));
  if (!arguments.gcode.empty())
    text::write_file(arguments.gcode,
                     plan::poses_gcode(machine, plan.states, "touches of " + arguments.artefact));
  write_json(arguments.json, json);
  fmt::print(human_stream(arguments.json), "{}", plan::touch_plan_text(plan, arguments.artefact));
}

/// Without measurements: where to measure a machine for the first time.
void run_first_plan(const PlanArguments& arguments) {
  if (!arguments.separate.empty())
    throw text::InputError({}, "MEAS", "distinguishing two effects needs measurements: name their files");
  const model::Machine machine = model::parse_machine(text::read_file(arguments.machine), arguments.machine);
  plan::FirstPlanOptions options;
  options.reading_um = arguments.reading_um.value_or(options.reading_um);
  if (arguments.accuracy_um > 0) options.accuracy_um = arguments.accuracy_um;
  if (arguments.points > 0) options.most = arguments.points;
  if (arguments.expected_um > 0) options.expected_um = arguments.expected_um;
  const plan::FirstPlan plan = plan::first_plan(machine, options);
  const auto count = static_cast<std::size_t>(std::count(plan.check.begin(), plan.check.end(), 0));
  Json json = {{"machine", machine.name},       {"points", plan.check.size()},
               {"fit_points", count},           {"check_points", plan.check.size() - count},
               {"references", plan.references}, {"u95_before_um", plan.before_um},
               {"u95_um", plan.after_um},       {"u95_random_um", plan.random_um},
               {"u95_least_um", plan.least_um}, {"reached", plan.reached},
               {"rows", Json::array()}};
  for (std::size_t row = 0; row < plan.check.size(); ++row) {
    Json one = {{"role", plan.check[row] != 0 ? "check" : "fit"}};
    one.update(pose_json(machine, plan.states, row));
    json["rows"].push_back(std::move(one));
  }
  if (!plan.reached)
    throw text::LimitNotMet(
        fmt::format("U95 of {:g} um cannot be reached: {} poses give {:.3g} um, and all considered poses "
                    "together give {:.3g} um",
                    arguments.accuracy_um, count, plan.after_um, plan.least_um));
  if (!arguments.output.empty())
    text::write_file(arguments.output, plan::first_plan_csv(machine, plan, options.reading_um));
  if (!arguments.gcode.empty())
    text::write_file(arguments.gcode,
                     plan::poses_gcode(machine, plan.states, "first measurement of " + machine.name));
  write_json(arguments.json, json);
  fmt::print(
      human_stream(arguments.json),
      "{} poses to fit ({} of them repeat the first pose) and {} to check: U95 of the tool point {:.3g} um "
      "(k = 2, mean over the volume), now {:.3g} um; the same number of random poses gives {:.3g} um\n",
      count, plan.references, plan.check.size() - count, plan.after_um, plan.before_um, plan.random_um);
}

void run_plan(const PlanArguments& arguments) {
  if (arguments.check && !(arguments.measurements.empty() && arguments.separate.empty()))
    throw text::InputError(
        {}, "--check",
        "a plan with --check is made from the fitted machine file alone: give no measurement files");
  if (arguments.check) return run_check_plan(arguments);
  if (!arguments.positioning.axis.empty()) {
    if (!arguments.measurements.empty() || !arguments.separate.empty())
      throw text::InputError({}, "--positioning",
                             "--positioning needs only the machine file, no measurements");
    return run_positioning_plan(arguments);
  }
  if (!arguments.artefact.empty()) {
    if (!arguments.measurements.empty() || !arguments.separate.empty())
      throw text::InputError(
          {}, "--artefact",
          "a plan with --artefact is made from the machine file alone: give no measurement files");
    return run_touch_plan(arguments);
  }
  const bool aimed = !arguments.part.path.empty() || !arguments.region.empty() || !arguments.tool.empty();
  if (aimed && !arguments.separate.empty())
    throw text::InputError({}, "--separate",
                           "this option distinguishes two effects, and --part, --region and --tool state "
                           "where the accuracy matters: give only one of the two kinds");
  if (arguments.measurements.empty() && !aimed) return run_first_plan(arguments);
  if (arguments.separate.empty()) return run_accuracy_plan(arguments);
  const std::string text = text::read_file(arguments.machine);
  const model::Machine machine = model::parse_machine(text, arguments.machine);
  const model::Measurement m = rows_of_plan(arguments, machine);
  const std::vector<effects::Effect> effects = effects::effect_catalogue(arguments.effects);
  const std::vector<std::string> hypotheses = plan::split_hypotheses(arguments.separate, effects);
  plan::PlanOptions options;
  options.confidence = arguments.confidence;
  if (arguments.points > 0) options.points = arguments.points;
  const plan::Plan plan = plan::plan_next(text, machine, m, hypotheses[0], hypotheses[1], effects, options);
  if (!arguments.output.empty()) text::write_file(arguments.output, plan::plan_csv(plan));
  if (!arguments.gcode.empty()) text::write_file(arguments.gcode, plan::plan_gcode(plan));
  write_json(arguments.json, plan_json(plan, arguments.confidence));
  std::FILE* out = human_stream(arguments.json);
  fmt::print(out, "{}\n\n", plan.sentence);
  for (const auto& [hypothesis, side] : {std::pair(&plan.a, &plan.a_true), std::pair(&plan.b, &plan.b_true)})
    fmt::print(out,
               "if {} is the true effect: non-centrality now {:.3g}, with the plan {:.3g}, required {:.3g}\n",
               hypothesis->candidate.label, side->now, plan.rows.rows() > 0 ? side->planned : side->now,
               side->needed);
  for (const std::string& other : plan.ruled_out) fmt::print(out, "the plan also distinguishes: {}\n", other);
  for (const std::string& other : plan.not_ruled_out)
    fmt::print(out, "the plan does not distinguish: {}\n", other);
  if (plan.rows.rows() > 0) fmt::print(out, "\n{}", plan::plan_table(plan));
}

}  // namespace

model::Measurement rows_of_plan(const PlanArguments& arguments, const model::Machine& machine) {
  model::Measurement rows = model::read_measurement(arguments.measurements, machine,
                                                    simulate::corrections_of_images(arguments.images));
  for (const fit::FileNoise& noise : fit::estimate_file_noise(machine, rows))
    fmt::print(stderr, "note: {}\n", noise.sentence());
  return rows;
}

nlohmann::ordered_json pose_json(const model::Machine& machine, const model::States& states,
                                 std::size_t row) {
  Json json = Json::object();
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    json["axes"][machine.axes[i].name] = states.axis[i][static_cast<Eigen::Index>(row)];
    json["dir"][machine.axes[i].name] = states.direction[i][static_cast<Eigen::Index>(row)];
  }
  return json;
}

void register_plan(CLI::App& vernier) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command = vernier.add_subcommand(
      "plan",
      "Plan the next measurement: a first survey, poses for accuracy, poses that distinguish two effects, or "
      "the test of one axis");
  command->add_option("MACHINE", arguments->machine, "machine file (XML)")->type_name(kReads)->required();
  command
      ->add_option("MEAS", arguments->measurements,
                   "measurement files (CSV); without measurement files the command plans the first survey")
      ->type_name(kReads);
  // One value each time: what follows it may be a measurement file.
  command
      ->add_option("--separate", arguments->separate,
                   "the two effects to distinguish, A,B: ids of effects or `add` strings; or give the option "
                   "twice, once for each effect")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
  command
      ->add_option("-o,--output", arguments->output,
                   "output file (CSV): the planned rows, with empty cells for the readings")
      ->type_name(kWrites);
  command->add_option("--gcode", arguments->gcode, "the rows as G-code")->type_name(kWrites);
  command
      ->add_option("--points", arguments->points,
                   "number of points of the plan (default: as few as necessary; for accuracy at most 200)")
      ->check(CLI::Range(1, 500));
  command
      ->add_option("--confidence", arguments->confidence,
                   "required probability that the measurement selects the true effect")
      ->check(CLI::Range(0.5001, 0.9999))
      ->capture_default_str();
  command->add_option("--effects", arguments->effects, "files with effects of your own; may be repeated")
      ->type_name(kReads);
  command
      ->add_option(
          "--accuracy", arguments->accuracy_um,
          "U95 of the tool point that the plan must reach, um, over the working volume or over --part and "
          "--region; with --check: largest change of the tool point that may stay undetected")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--reading", arguments->reading_um,
                   "standard uncertainty of a planned reading of one coordinate, um (default 5; with MEAS: "
                   "the u of its readings)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--expected", arguments->expected_um,
                   "first plan: expected displacement of the tool point by one parameter, um (default 100); "
                   "--check: smallest change of the tool point that the check must detect, um (default 20)")
      ->check(CLI::PositiveNumber);
  command->add_flag("--check", arguments->check,
                    "plan a short measurement for `vernier check` of a fitted machine (default: 10 points)");
  command->add_option("--artefact", arguments->artefact,
                      "plan touches of this <artefact> of the machine file (default: 40 at most), and list "
                      "the parameters that no touch of it determines");
  plan::PositioningTestOptions& test = arguments->positioning;
  CLI::Option* const positioning = command->add_option(
      "--positioning", test.axis,
      "AXIS: plan the positioning test of ISO 230-2 with a laser or a dial gauge: NC program (--gcode) and "
      "rows for the readings (-o); --points: number of targets (default: as the standard requires)");
  command->add_option("--from", test.from, "first target, mm or deg (default: the range less --overrun)")
      ->needs(positioning);
  command->add_option("--to", test.to, "last target, mm or deg")->needs(positioning);
  command
      ->add_option("--overrun", test.overrun,
                   "travel beyond the end targets, mm or deg (default: 1 % of the range)")
      ->check(CLI::PositiveNumber)
      ->needs(positioning);
  command
      ->add_option("--period", test.period,
                   "period of a possible periodic error, mm or deg: each target is shifted by a random "
                   "amount of at most one period (default: 30 % of the interval)")
      ->check(CLI::PositiveNumber)
      ->needs(positioning);
  command->add_option("--runs", test.runs, "runs in both directions (default: 5; 1 on an axis beyond 2 m)")
      ->check(CLI::Range(1, 50))
      ->needs(positioning);
  command
      ->add_option("--part", arguments->part.path,
                   "plan for the accuracy at the features of this part (CSV, or a part program)")
      ->type_name(kReads);
  command->add_option(
      "--place", arguments->part.place,
      "zero of the part in workpiece coordinates: \"X,Y,Z\", \"X,Y,Z,TURN\" or \"X,Y,Z,rX,rY,rZ\"");
  command->add_option("--zero", arguments->part.zero, "machine position of the zero of a part program");
  command->add_option("--at", arguments->part.at,
                      "values of inputs, and positions of the axes that the part does not state; with "
                      "--positioning: positions of the other axes (default: mid-range)");
  command->add_option("--region", arguments->region,
                      "plan for the accuracy in this part of the working volume: \"X=100:200,Y=0:50\"");
  command->add_option(
      "--tool", arguments->tool,
      "accuracy for this tool alone: one of <tools>, or \"X,Y,Z\" in mm from the end of the chain");
  command
      ->add_option("--feed", arguments->feed_mm_min,
                   "speed from pose to pose, mm/min (deg/min); the command estimates the duration of the "
                   "plan with this "
                   "value, and writes it to the program of --positioning")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--dwell", arguments->dwell_s,
                   "time for settling and reading at one pose, s; the command estimates the duration of the "
                   "plan with this value. With --positioning: dwell of the program; 0: the program stops at "
                   "each target")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--images", arguments->images, simulate::kImagesHelp)->type_name(kReadsFolder);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "With MEAS and --accuracy the command fits the model, then chooses the next poses one by one: each "
      "pose gives the largest\n"
      "decrease of U95 (k = 2) over the volume, a region or the features of a part, until U95 is at most "
      "--accuracy.\n"
      "With --separate the command fits the model with each effect, then chooses the rows whose readings "
      "differ most after the\n"
      "wrong effect and all free parameters were fitted again (T-optimal, the worse of both directions). The "
      "number of points\n"
      "is sufficient for a non-centrality of (z + sqrt(z^2 + 6))^2, where z is the normal quantile of the "
      "confidence.\n"
      "Exit status 0 done (also if no pose distinguishes the two effects: a sentence reports this), 1 bad "
      "input or usage\n"
      "(nothing written), 2 the required accuracy cannot be reached (nothing written), 70 internal error. "
      "See tools/docs/plan.md.");
  command->callback([arguments] { run_plan(*arguments); });
}

}  // namespace vernier::commands::plan_cli
