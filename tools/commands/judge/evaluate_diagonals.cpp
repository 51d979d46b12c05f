// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/judge/evaluate_kinds.h"
#include "tools/commands/report_header.h"
#include "tools/evaluate/diagonals.h"
#include "tools/evaluate/limits.h"
#include "tools/evaluate/positioning_page.h"
#include "tools/report/report.h"
#include "tools/text/error.h"

namespace vernier::commands::evaluate_cli {
namespace {

using Json = nlohmann::ordered_json;

struct DiagonalArguments {
  std::vector<std::string> measurements, tolerances, uncertainties;
  std::string reading = "displacement", output, json;
  ReportHeader header;
};

const std::vector<std::string> kLetters = {"E", "A", "M", "R", "B"};
constexpr std::size_t kBody = 6;  // letters of a name of a body diagonal: "+X+Y+Z"

/// The machine's values: the largest of its body diagonals, judged.
Json machine_json(const std::map<std::string, double>& values, const evaluate::PositioningWords& words) {
  constexpr double kUmPerMm = 1000;
  Json list = Json::array();
  for (const std::string& letter : kLetters) {
    const auto value = values.find(letter);
    if (value == values.end()) continue;
    const auto limit = words.tolerance.find(letter), u = words.uncertainty.find(letter);
    const double expanded = u == words.uncertainty.end() ? 0 : u->second;
    Json one = {{"name", letter + "_d"},
                {"value", value->second * kUmPerMm},
                {"uncertainty", u == words.uncertainty.end() ? Json(nullptr) : Json(expanded * kUmPerMm)}};
    if (limit != words.tolerance.end()) {
      one["tolerance"] = limit->second * kUmPerMm;
      one["conformity"] =
          evaluate::conformity_text(evaluate::conformity(value->second, limit->second, expanded));
    }
    list.push_back(one);
  }
  return list;
}

Json page_of(const Json& json, const std::vector<Json>& each, const std::vector<std::string>& files) {
  Json tiles = Json::array(), rows = Json::array(), sections = Json::array();
  for (const Json& one : json["machine"]) {
    tiles.push_back(
        {{"label", one["name"]}, {"value", one["value"]}, {"unit", "µm"}, {"strong", one["name"] == "E_d"}});
    Json row = {one["name"], one["value"], one["uncertainty"], nullptr,
                one.value("conformity", Json(nullptr))};
    if (const auto judged = evaluate::judged_of(one)) {
      const evaluate::JudgedText text = evaluate::judged_text(*judged, evaluate::kPrintedDigits);
      row[1] = text.value, row[2] = text.uncertainty, row[3] = text.tolerance;
    }
    rows.push_back(std::move(row));
  }
  if (!rows.empty())
    sections.push_back({{"title", "The machine (ISO 230-6)"},
                        {"prose",
                         {"The largest value of the body diagonals. E_d is the diagonal systematic "
                          "deviation, B_d the reversal."}},
                        {"numbers", tiles},
                        {"tables",
                         {{{"caption", "in µm"},
                           {"columns", {"", "value", "U (k = 2)", "tolerance", "conformity"}},
                           {"rows", rows}}}}});
  for (const Json& page : each)
    for (const Json& section : page["sections"]) sections.push_back(section);
  return {{"title", "Diagonal displacement"}, {"machine", ""}, {"files", files}, {"sections", sections}};
}

void print(std::FILE* out, const Json& json) {
  for (const Json& one : json["diagonals"]) {
    fmt::print(out, "{:<8} {:>9.3f} mm, {} targets:", one["diagonal"].get<std::string>(),
               one["length_mm"].get<double>(), one["n_targets"].get<std::size_t>());
    for (const Json& value : one["characteristics"]) {
      const auto name = value["name"].get<std::string>();
      if (name.size() == 1 && !value["value"].is_null())
        fmt::print(out, " {} {:.2f}", name, value["value"].get<double>());
    }
    fmt::print(out, " um\n");
  }
  for (const Json& one : json["machine"]) {
    const auto judged = evaluate::judged_of(one);
    const auto text =
        judged ? evaluate::judged_text(*judged, evaluate::kPrintedDigits) : evaluate::JudgedText{};
    fmt::print(
        out, "{:<8} {:>9} um", one["name"].get<std::string>(),
        judged ? text.value : fmt::format("{:.{}f}", one["value"].get<double>(), evaluate::kPrintedDigits));
    if (!one["uncertainty"].is_null())
      fmt::print(out, ", U {}",
                 judged ? text.uncertainty : fmt::format("{:.3g}", one["uncertainty"].get<double>()));
    if (judged) fmt::print(out, "; tolerance {}: {}", text.tolerance, one["conformity"].get<std::string>());
    fmt::print(out, "\n");
  }
}

/// Acceptance rule of the machine's values.
text::Assurance assurance_of(const Json& machine) {
  std::vector<evaluate::JudgedValue> all;
  for (const Json& one : machine)
    if (auto judged = evaluate::judged_of(one)) all.push_back(std::move(*judged));
  return evaluate::assurance_of(all, "um");
}

void run_diagonals(const DiagonalArguments& arguments) {
  evaluate::PositioningWords words;
  for (const std::string& one : arguments.tolerances)
    words.tolerance.insert(evaluate::limit_of(one, "--tolerance", kLetters));
  for (const std::string& one : arguments.uncertainties)
    words.uncertainty.insert(evaluate::limit_of(one, "--uncertainty", kLetters));
  words.header = arguments.header.entries();
  Json json = {{"standard", "ISO 230-6"}, {"diagonals", Json::array()}};
  std::vector<Json> pages;
  std::map<std::string, evaluate::PositioningResult> body;
  for (const std::string& path : arguments.measurements)
    for (const evaluate::DiagonalFile& one :
         evaluate::read_diagonals(text::read_file(path), path, arguments.reading)) {
      const evaluate::PositioningResult result = evaluate::evaluate_positioning(one.positions.readings);
      evaluate::PositioningWords along;
      along.axis = one.name;
      if (one.name.size() == kBody && !body.emplace(one.name, result).second)
        throw text::InputError(fmt::format(
            "{}: the diagonal {} is in two files: put all rows of a diagonal into one file", path, one.name));
      Json each = {{"diagonal", one.name}, {"length_mm", one.length}};
      const Json evaluated = evaluate::positioning_json(result, one.positions, along);
      pages.push_back(evaluate::positioning_page(evaluated, along));
      pages.back()["sections"][0]["title"] = "Diagonal " + one.name;
      for (const auto& [key, value] : evaluated.items())
        if (key != "standard" && key != "axis" && key != "assurance") each[key] = value;
      json["diagonals"].push_back(each);
    }
  json["machine"] = machine_json(evaluate::machine_values(body), words);
  json["assurance"] = assurance_of(json["machine"]).json();
  if (!arguments.output.empty())
    text::write_file(
        arguments.output,
        report::improvement_report_html(arguments.header.on(page_of(json, pages, arguments.measurements))));
  write_json(arguments.json, json);
  print(human_stream(arguments.json), json);
  for (const Json& one : json["machine"])
    if (one.contains("conformity") &&
        one["conformity"] == evaluate::conformity_text(evaluate::Conformity::kNotMet))
      throw text::LimitNotMet("the tolerance of " + one["name"].get<std::string>() + " is not met");
}

}  // namespace

void add_diagonals_kind(CLI::App& evaluate) {
  auto arguments = std::make_shared<DiagonalArguments>();
  CLI::App* kind =
      evaluate.add_subcommand("iso230-6", "Diagonal displacement tests of a machine's volume and faces");
  kind->add_option("MEAS", arguments->measurements, "measurement files (CSV): X Y Z and the displacement")
      ->type_name(kReads)
      ->required();
  kind->add_option("--reading", arguments->reading, "column of the displacement along the diagonal")
      ->capture_default_str();
  kind->add_option("--tolerance", arguments->tolerances,
                   "tolerance of the largest value of the body diagonals: E=20um (also A M R B)")
      ->allow_extra_args(false);
  kind->add_option("--uncertainty", arguments->uncertainties,
                   "expanded uncertainty (k = 2) of a characteristic: E=3um")
      ->allow_extra_args(false);
  add_report_header(*kind, arguments->header);
  kind->add_option("-o,--output", arguments->output, "report (HTML)")->type_name(kWrites);
  kind->add_option("--json", arguments->json,
                   "file for the result as JSON, for programs; - for standard output");
  kind->footer(
      "Each diagonal is evaluated like an axis by ISO 230-2; the position is the distance along the "
      "diagonal. The result for the machine is the largest value of its body diagonals (E_d, B_d …). Exit "
      "status 0 "
      "done, 1 bad input, "
      "2 a "
      "tolerance is not met (ISO 14253-1).");
  kind->callback([arguments] { run_diagonals(*arguments); });
}

}  // namespace vernier::commands::evaluate_cli
