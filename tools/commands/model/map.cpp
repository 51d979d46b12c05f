// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/commands/report_header.h"
#include "tools/format/columns.h"
#include "tools/map/simulated.h"
#include "tools/maths/factors.h"
#include "tools/report/report.h"
#include "tools/results/field_json.h"

namespace vernier::commands::map_cli {
namespace {

using Json = nlohmann::ordered_json;

struct MapArguments {
  std::string machine, correction, output, json, at, lines;
  std::vector<std::string> over;
  std::size_t grid = 7;
  ReportHeader header;
};

/// Part of the standard uncertainty above which the text states that it is not measured: half of the
/// variance.
constexpr double kMostlyOpen = 0.7;

constexpr const char* kNotMeasured =
    "the command simulates no lengths, diagonals, circles or squares, because the machine does not have one "
    "to three linear axes with min and max";

bool can_be_measured(const model::Machine& machine) {
  const std::vector<std::size_t> axes = kinematics::linear_axes(machine);
  return !axes.empty() && axes.size() <= 3 && std::all_of(axes.begin(), axes.end(), [&](std::size_t axis) {
    return machine.axes[axis].min && machine.axes[axis].max;
  });
}

void add_measurements(Json& json, const model::Machine& machine, const model::States& at,
                      const std::string& lines) {
  const map::Bench bench(machine, at);
  json["lengths"] = json["diagonals"] = Json::array();
  for (const map::LineResult& line : map::axis_lines(machine, bench))
    json["lengths"].push_back(map::line_json(line));
  double worst = 0, reversal = 0;
  for (const map::LineResult& line : map::diagonals(machine, bench)) {
    json["diagonals"].push_back(map::line_json(line));
    worst = std::max(worst, line.error_um);
    reversal = std::max(reversal, line.reversal_um);
  }
  json["diagonal_deviation_um"] = worst;
  json["diagonal_reversal_um"] = reversal;
  json["circles"] = map::circles_json(bench);
  json["squares"] = map::squares_json(bench);
  json["cylinder"] = map::cylinder_json(bench);
  json["free_lines"] = lines.empty() ? Json::array() : map::free_lines_json(bench, lines);
}

Json line_table(const char* caption, const Json& lines) {
  Json rows = Json::array();
  for (const Json& line : lines)
    rows.push_back(
        {line["name"], line["length_mm"], line["E_um"], line["M_um"], line["B_um"], line["straightness_um"]});
  return {{"caption", caption},
          {"columns", {"line", "length [mm]", "E [µm]", "M [µm]", "B [µm]", "straightness [µm]"}},
          {"rows", rows}};
}

Json line_plot(const Json& line) {
  return {{"x",
           {{"name", "along " + line["name"].get<std::string>()},
            {"unit", "mm"},
            {"values", line["distance_mm"]}}},
          {"y",
           {{{"name", "forward"}, {"unit", "µm"}, {"values", line["forward_um"]}},
            {{"name", "reverse"}, {"unit", "µm"}, {"values", line["reverse_um"]}}}},
          {"caption", "Deviation along the line, relative to the first point of the line."}};
}

Json line_section(const char* title, const char* prose, const char* caption, const Json& lines) {
  Json plots = Json::array();
  for (const Json& line : lines) plots.push_back(line_plot(line));
  return {{"title", title}, {"prose", {prose}}, {"tables", {line_table(caption, lines)}}, {"plots", plots}};
}

Json shape_section(const Json& json) {
  Json circles = Json::array(), squares = Json::array(), tables = Json::array();
  for (const Json& one : json["circles"])
    circles.push_back({one["plane"], one["radius_mm"], one["circular_deviation_ccw_um"],
                       one["circular_deviation_cw_um"], one["bidirectional_um"], one["hysteresis_um"]});
  for (const Json& one : json["squares"])
    squares.push_back({one["plane"], one["side_mm"], one["angle_um_per_m"], one["straightness_um"]});
  tables.push_back({{"caption", "Circles (ISO 230-4)"},
                    {"columns",
                     {"plane", "radius [mm]", "circular dev. CCW [µm]", "CW [µm]", "bidirectional [µm]",
                      "hysteresis [µm]"}},
                    {"rows", circles}});
  tables.push_back({{"caption", "Squares"},
                    {"columns", {"plane", "side [mm]", "angle from 90° [µm/m]", "straightness [µm]"}},
                    {"rows", squares}});
  if (const Json& c = json["cylinder"]; !c.is_null())
    tables.push_back(
        {{"caption", "Cylinder along Z"},
         {"columns", {"radius [mm]", "height [mm]", "cylindricity [µm]", "radius deviation [µm]"}},
         {"rows", {{c["radius_mm"], c["height_mm"], c["cylindricity_um"], c["radius_deviation_um"]}}}});
  Json lines = Json::array();
  for (const Json& one : json["free_lines"])
    lines.push_back({one["run"], one["length_mm"], one["length_deviation_um"], one["straightness_um"]});
  if (!lines.empty())
    tables.push_back({{"caption", "Free lines"},
                      {"columns", {"line", "length [mm]", "length deviation [µm]", "straightness [µm]"}},
                      {"rows", lines}});
  return {{"title", "Shapes"},
          {"prose",
           {"The largest circle (radius reduced by a tenth) and the largest square about the middle of the "
            "volume, and a cylinder."}},
          {"tables", tables}};
}

/// Adds the deviation that remains with the correction of a machine file to the field.
void add_corrected(Json& field, const model::Machine& machine, const map::ErrorField& nodes,
                   const std::string& file) {
  const Eigen::Matrix3Xd after = map::corrected_deviation(machine, nodes, read_model(file));
  field["correction"] = file;
  field["after_um"] = Json::array();
  for (Eigen::Index i = 0; i < after.cols(); ++i)
    field["after_um"].push_back(
        {maths::kUmPerMm * after(0, i), maths::kUmPerMm * after(1, i), maths::kUmPerMm * after(2, i)});
  const Eigen::VectorXd size_um = maths::kUmPerMm * after.colwise().norm();
  field["after_max_um"] = size_um.maxCoeff();
  field["after_rms_um"] = std::sqrt(size_um.squaredNorm() / static_cast<double>(size_um.size()));
}

Json page_of(const Json& json) {
  const Json& field = json["field"];
  const auto number = [](const char* label, const Json& value, bool strong) {
    return Json{{"label", label}, {"value", value}, {"unit", "µm"}, {"strong", strong}};
  };
  Json numbers = {number("largest deviation", field["max_um"], true),
                  number("rms of the field", field["rms_um"], false)};
  if (field.contains("after_um")) {
    numbers.push_back(number("largest deviation, corrected", field["after_max_um"], true));
    numbers.push_back(number("rms of the field, corrected", field["after_rms_um"], false));
  }
  Json sections = Json::array();
  const bool measured = json.contains("diagonals");
  if (measured) {
    numbers.push_back(number("diagonals: largest E", json["diagonal_deviation_um"], false));
    numbers.push_back(number("diagonals: largest B", json["diagonal_reversal_um"], false));
  }
  sections.push_back(
      {{"title", "Error field"},
       {"prose",
        {"Deviation of the tool point, actual minus nominal, over the declared axis ranges, in "
         "workpiece coordinates. Drag or use the arrow keys to turn it."}},
       {"numbers", numbers},
       {"field", field},
       {"notes", json["notes"]}});
  if (measured) {
    sections.push_back(line_section("Diagonals",
                                    "Readings of a laser along the diagonals (ISO 230-6), one run "
                                    "in each approach direction. The last position is reached from one side "
                                    "only: both runs have one value there.",
                                    "Body and face diagonals", json["diagonals"]));
    sections.push_back(line_section(
        "Axes",
        "Readings along each axis through the middle of the volume, one run in each approach direction.",
        "Single axes", json["lengths"]));
    sections.push_back(shape_section(json));
  }
  return {{"title", "Volumetric map"},
          {"machine", json["machine"]},
          {"files", json["files"]},
          {"sections", sections}};
}

void run_map(const MapArguments& arguments) {
  const model::Machine machine = read_model(arguments.machine);
  const model::States at = results::middle_state(machine, arguments.at);
  std::vector<std::size_t> axes = kinematics::linear_axes(machine);
  if (!arguments.over.empty()) axes.clear();
  for (const std::string& name : arguments.over) {
    const auto axis = machine.find_axis(name);
    if (!axis) throw text::InputError({machine.file, 0}, name, "the machine has no axis of this name");
    axes.push_back(*axis);
  }
  if (axes.empty())
    throw text::InputError({machine.file, 0}, "",
                           "the machine has no linear axis: name the axes to show, --over J1,J2,J3");
  Json json = {{"machine", machine.name}, {"files", {arguments.machine}}, {"notes", Json::array()}};
  const map::ErrorField field = map::error_field(machine, at, axes, arguments.grid);
  json["field"] = results::field_json(machine, field);
  if (!arguments.correction.empty()) add_corrected(json["field"], machine, field, arguments.correction);
  const bool measured = can_be_measured(machine);
  if (measured)
    add_measurements(json, machine, at, arguments.lines);
  else if (!arguments.lines.empty())
    throw text::InputError({machine.file, 0}, "", kNotMeasured);
  else
    json["notes"].push_back(kNotMeasured);
  if (!arguments.output.empty())
    text::write_file(arguments.output, report::improvement_report_html(arguments.header.on(page_of(json))));
  write_json(arguments.json, json);
  std::FILE* out = human_stream(arguments.json);
  fmt::print(out, "largest deviation {:.4g} um, rms {:.4g} um over {} nodes\n",
             json["field"]["max_um"].get<double>(), json["field"]["rms_um"].get<double>(),
             json["field"]["point_mm"].size());
  if (json["field"].contains("after_um"))
    fmt::print(out, "with the correction of {}: largest deviation {:.4g} um, rms {:.4g} um\n",
               arguments.correction, json["field"]["after_max_um"].get<double>(),
               json["field"]["after_rms_um"].get<double>());
  if (!json["field"]["std_um"].is_null())
    fmt::print(out,
               "standard uncertainty of the model {:.4g} um on average, {:.4g} um at most (also outside the "
               "measured range)\n",
               json["field"]["rms_std_um"].get<double>(), json["field"]["max_std_um"].get<double>());
  if (!json["field"]["std_um"].is_null()) {
    const double all = json["field"]["rms_std_um"].get<double>(),
                 open = json["field"]["rms_std_not_measured_um"].get<double>();
    if (open > kMostlyOpen * all)
      fmt::print(out,
                 "not measured: {:.4g} um of this uncertainty come from parameters that no reading "
                 "determined; these parameters stay at nominal +- scale\n",
                 open);
  }
  if (!measured) fmt::print(out, "{}\n", kNotMeasured);
  if (!measured) return;
  for (const Json& line : json["diagonals"])
    fmt::print(out, "diagonal {:<9} E {:.4g} um  M {:.4g} um  B {:.4g} um\n", line["name"].get<std::string>(),
               line["E_um"].get<double>(), line["M_um"].get<double>(), line["B_um"].get<double>());
}

}  // namespace

void register_map(CLI::App& vernier) {
  auto arguments = std::make_shared<MapArguments>();
  CLI::App* command = vernier.add_subcommand(
      "map", "Show the error over the working volume and the uncertainty of this error");
  command->add_option("MACHINE", arguments->machine, "machine file (XML)")->type_name(kReads)->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "file for the report (HTML, one file that opens without a network)")
      ->type_name(kWrites);
  add_report_header(*command, arguments->header);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->add_option("--grid", arguments->grid, "nodes along each axis")
      ->check(CLI::Range(2, 40))
      ->capture_default_str();
  command
      ->add_option("--correction", arguments->correction,
                   "machine file whose model corrects the axes: the map shows the error without and with "
                   "this correction")
      ->type_name(kReads);
  command->add_option("--inputs,--at", arguments->at,
                      "constant values of inputs, motion and the other axes: \"T=25,B=30\"");
  command
      ->add_option("--over", arguments->over,
                   "axes over whose ranges the error is shown, one to three; default: the linear axes")
      ->delimiter(',');
  command
      ->add_option("--lines", arguments->lines,
                   "free lines to measure (CSV): " + format::headings(format::columns::kPoint) + "," +
                       format::columns::kRun)
      ->type_name(kReads);
  command->footer(
      "Lengths and diagonals with reversal (ISO 230-6), circles (ISO 230-4), squares, a cylinder, free "
      "lines.");
  command->callback([arguments] { run_map(*arguments); });
}

}  // namespace vernier::commands::map_cli
