// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/judge/evaluate_kinds.h"
#include "tools/commands/report_header.h"
#include "tools/evaluate/budget.h"
#include "tools/evaluate/limits.h"
#include "tools/evaluate/positioning_page.h"
#include "tools/report/report.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::commands::evaluate_cli {
namespace {

struct PositioningArguments {
  std::vector<std::string> measurements, axes, tolerances, uncertainties, budget;
  ReportHeader header;
  std::string reading, output, json;
};

const std::vector<std::string> kCharacteristics = {"A", "E", "M", "R", "B"};

void print_result(std::FILE* out, const nlohmann::ordered_json& json) {
  fmt::print(out, "axis {}: {} targets, {} readings, sense {}\n", json["axis"].get<std::string>(),
             json["n_targets"].get<std::size_t>(), json["n_rows"].get<std::size_t>(),
             json["sense"].get<std::string>());
  if (const auto undirected = json["n_undirected"].get<std::size_t>(); undirected > 0)
    fmt::print(
        out,
        "note: {} readings have no approach direction ({} is 0) and are omitted: ISO 230-2 evaluates each "
        "direction for itself\n",
        undirected, json["sense"].get<std::string>());
  const std::string unit = json["unit"];
  for (const auto& one : json["characteristics"]) {
    if (one["value"].is_null()) continue;
    const auto judged = evaluate::judged_of(one);
    const std::string value =
        judged ? evaluate::judged_text(*judged, evaluate::kPrintedDigits).value
               : fmt::format("{:.{}f}", one["value"].get<double>(), evaluate::kPrintedDigits);
    fmt::print(out, "  {:<7} {:>10} {:<7}{}", one["name"].get<std::string>(), value, unit,
               one["meaning"].get<std::string>());
    if (!one["uncertainty"].is_null())
      fmt::print(out, ", U {}",
                 judged ? evaluate::judged_text(*judged, evaluate::kPrintedDigits).uncertainty
                        : fmt::format("{:.3g}", one["uncertainty"].get<double>()));
    if (judged)
      fmt::print(out, "; tolerance {}: {}",
                 evaluate::judged_text(*judged, evaluate::kPrintedDigits).tolerance,
                 one["conformity"].get<std::string>());
    fmt::print(out, "\n");
  }
}

double length_of(const evaluate::PositioningFile& file) {
  return file.readings.back().target - file.readings.front().target;
}

/// The uncertainties of the budget, if no others are stated.
evaluate::PositioningBudget budget_of(const PositioningArguments& arguments,
                                      const evaluate::PositioningFile& file,
                                      evaluate::PositioningWords& words) {
  evaluate::PositioningBudget budget;
  for (const std::string& one : arguments.budget) evaluate::add_to_budget(budget, one);
  if (!budget.given) return budget;
  if (file.unit != "mm")
    throw text::InputError("--budget is only for a linear axis; for a rotary axis give --uncertainty");
  std::size_t runs = file.rows;
  for (const evaluate::TargetReadings& target : file.readings)
    for (const auto& list : target.deviation)
      if (!list.empty()) runs = std::min(runs, list.size());
  for (const auto& [name, value] :
       evaluate::budget_uncertainty(budget, length_of(file), static_cast<double>(runs)))
    words.uncertainty.try_emplace(name, value);
  return budget;
}

void run_positioning(const PositioningArguments& arguments) {
  if (arguments.axes.size() != 1)
    throw text::InputError("--axis: give only one axis; call the command again for each further axis");
  evaluate::PositioningWords words;
  words.axis = arguments.axes.front();
  words.files = arguments.measurements;
  words.header = arguments.header.entries();
  const std::string reading =
      arguments.reading.empty() ? text::in_small_letters(words.axis) : arguments.reading;
  evaluate::PositioningFile all;
  for (const std::string& path : arguments.measurements) {
    evaluate::PositioningFile one =
        evaluate::read_positioning(text::read_file(path), path, words.axis, reading);
    all.unit = one.unit;
    all.rows += one.rows;
    all.undirected += one.undirected;
    all.sense_from_order |= one.sense_from_order;
    for (evaluate::TargetReadings& target : one.readings) {
      bool known = false;
      for (evaluate::TargetReadings& other : all.readings)
        if (std::abs(other.target - target.target) < 1e-6) {
          known = true;
          for (std::size_t sense = 0; sense < 2; ++sense)
            other.deviation[sense].insert(other.deviation[sense].end(), target.deviation[sense].begin(),
                                          target.deviation[sense].end());
        }
      if (!known) all.readings.push_back(std::move(target));
    }
  }
  std::sort(all.readings.begin(), all.readings.end(),
            [](const auto& a, const auto& b) { return a.target < b.target; });
  for (const std::string& one : arguments.tolerances)
    words.tolerance.insert(evaluate::limit_of(one, "--tolerance", kCharacteristics, all.unit));
  for (const std::string& one : arguments.uncertainties)
    words.uncertainty.insert(evaluate::limit_of(one, "--uncertainty", kCharacteristics, all.unit));
  const evaluate::PositioningBudget budget = budget_of(arguments, all, words);
  nlohmann::ordered_json json =
      evaluate::positioning_json(evaluate::evaluate_positioning(all.readings), all, words);
  if (budget.given)
    for (const evaluate::BudgetPart& part : evaluate::budget_parts(budget, length_of(all)))
      json["budget"].push_back({{"part", part.name}, {"U_um", part.expanded_um}});
  if (!arguments.output.empty())
    text::write_file(arguments.output, report::improvement_report_html(
                                           arguments.header.on(evaluate::positioning_page(json, words))));
  write_json(arguments.json, json);
  print_result(human_stream(arguments.json), json);
  for (const auto& one : json["characteristics"])
    if (one.contains("conformity") && one["conformity"].is_null())
      throw text::LimitNotMet(one["name"].get<std::string>() +
                              " cannot be compared with its tolerance, because the file lacks readings in "
                              "both approach directions, two runs each");
  for (const auto& one : json["characteristics"])
    if (one.contains("conformity") && one["conformity"] == "not met")
      throw text::LimitNotMet("the tolerance of " + one["name"].get<std::string>() + " is not met");
}

}  // namespace

void register_evaluate(CLI::App& vernier) {
  CLI::App* evaluate = vernier.add_subcommand("evaluate",
                                              "Evaluate a measurement by a standard: positioning (ISO "
                                              "230-2), diagonals (ISO 230-6), robots (ISO 9283)");
  evaluate->require_subcommand(1);
  auto arguments = std::make_shared<PositioningArguments>();
  CLI::App* kind =
      evaluate->add_subcommand("iso230-2", "Accuracy and repeatability of positioning of one axis");
  kind->add_option("MEAS", arguments->measurements, "measurement files (CSV)")->type_name(kReads)->required();
  kind->add_option("--axis", arguments->axes, "the axis that was moved")->required()->allow_extra_args(false);
  kind->add_option(
      "--reading", arguments->reading,
      "column with the measured positions of the axis; default: the name of the axis in small letters");
  kind->add_option(
          "--tolerance", arguments->tolerances,
          "tolerance of a characteristic: A=10um (also E M R B); repeat the option for each characteristic")
      ->allow_extra_args(false);
  kind->add_option("--uncertainty", arguments->uncertainties,
                   "expanded uncertainty (k = 2) of a characteristic: A=2um; repeat the option for each "
                   "characteristic")
      ->allow_extra_args(false);
  kind->add_option("--budget", arguments->budget,
                   "one contribution to the uncertainty budget, from which the command computes the "
                   "uncertainty of each characteristic: device=0.8 (um/m, k = 2), misalignment=1 (mm/m), "
                   "thermometer=1 (range, K), expansion=11.5 and expansion-range=2 (um/(m K)), away=3 (K "
                   "from 20), drift=1.5 (range, um); repeat the option for each contribution")
      ->allow_extra_args(false);
  add_report_header(*kind, arguments->header);
  kind->add_option("-o,--output", arguments->output, "report (HTML)")->type_name(kWrites);
  kind->add_option("--json", arguments->json,
                   "file for the result as JSON, for programs; - for standard output");
  kind->footer(
      "The deviation is the reading minus the commanded position. The command computes A, R, E, B, M by ISO "
      "230-2:2014, with the approach directions from dirX or from the order of the rows. Exit status 0 done, "
      "1 bad input, 2 a tolerance is not met (ISO 14253-1: the value exceeds the tolerance by more than its "
      "uncertainty).");
  kind->callback([arguments] { run_positioning(*arguments); });
  add_diagonals_kind(*evaluate);
  add_robot_kind(*evaluate);
}

}  // namespace vernier::commands::evaluate_cli
