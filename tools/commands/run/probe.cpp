// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>

#include "tools/commands/command.h"
#include "tools/probe/calibration.h"
#include "tools/probe/feature.h"
#include "tools/probe/path.h"
#include "tools/text/error.h"

namespace vernier::commands::probe_cli {
namespace {

using Json = nlohmann::ordered_json;

struct TableArguments {
  std::string file, json;
  std::vector<std::string> columns, where;
  double outlier_level = 0.01;
};

void add_table(CLI::App& command, TableArguments& arguments) {
  command.add_option("file", arguments.file, "CSV of touches")->type_name(kReads)->required();
  command
      .add_option("--column", arguments.columns,
                  "meaning of a column: \"mean_up_um=upper[um]\"; repeat the option for each column")
      ->allow_extra_args(false);
  command.add_option("--where", arguments.where, "only rows with this: \"group=A\"")->allow_extra_args(false);
  command
      .add_option("--outliers", arguments.outlier_level,
                  "probability that the outlier test excludes a touch of a set without outliers; 0: no touch "
                  "is excluded")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  command.add_option("--json", arguments.json,
                     "file for the result as JSON, for programs; - for standard output");
}

void add_conditions(CLI::App& command, probe::TouchConditions& conditions) {
  command
      .add_option(
          "--gain", conditions.gain_per_s,
          "gain of the position loop, 1/s: following error = speed / gain; default: 1.78 mm at 2540 mm/min")
      ->check(CLI::PositiveNumber);
  command.add_option("--stylus", conditions.stylus_mm, "largest permitted deflection of the stylus, mm")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

probe::TouchTable read_table(const TableArguments& arguments) {
  return {text::read_file(arguments.file), arguments.file, arguments.columns, arguments.where};
}

Json json_of(const std::vector<probe::Calibrated>& parameters) {
  Json list = Json::array();
  for (const probe::Calibrated& p : parameters)
    list.push_back({{"name", p.name}, {"value", p.value}, {"std", p.std}, {"unit", p.unit}});
  return list;
}

Json json_of(const probe::TouchFit& fit, const probe::TouchTable& table) {
  Json outliers = Json::array();
  for (const probe::TouchOutlier& o : fit.outliers)
    outliers.push_back({{"line", table.line(o.touch)},
                        {"row", o.touch + 1},
                        {"residual_um", o.residual * 1e3},
                        {"t", o.t},
                        {"p_value", o.p_value}});
  return outliers;
}

void print(std::FILE* out, const std::vector<probe::Calibrated>& parameters,
           const std::vector<std::string>& findings) {
  for (const probe::Calibrated& p : parameters)
    fmt::print(out, "  {:<22} {:>14.6f} +- {:<10.3g} {}\n", p.name, p.value, p.std, p.unit);
  for (const std::string& finding : findings) fmt::print(out, "- {}\n", finding);
}

// ---- probe-cal

struct CalArguments : TableArguments {
  std::string artefact, output;
  probe::CalibrationSetup setup;
  double ball_radius = 0, clearance = 0, overtravel = 0;
  std::string group;
};

Json json_of(const probe::GroupComparison& groups, const std::string& column) {
  Json list = Json::array();
  for (const probe::GroupComparison::Group& group : groups.groups)
    list.push_back(
        {{"value", group.value}, {"n_touches", group.touches}, {"parameters", json_of(group.parameters)}});
  return {{"column", column}, {"differ_p", groups.chance}, {"each", list}};
}

void print(std::FILE* out, const probe::GroupComparison& groups, const std::string& column) {
  for (const probe::GroupComparison::Group& group : groups.groups) {
    fmt::print(out, "  {} {} ({} touches):", column, group.value, group.touches);
    for (const probe::Calibrated& p : group.parameters)
      if (p.name == "delay" || p.name == "effective_tip_radius")
        fmt::print(out, "  {} {:.6f} +- {:.2g} {}", p.name, p.value, p.std, p.unit);
    fmt::print(out, "\n");
  }
  fmt::print(out, "- {}\n", groups.words);
}

std::string board_lines(const probe::ProbeCalibration& result) {
  const probe::Calibrated* const delay = result.find("delay");
  std::string text = "# for the [probe] section of a board file\n";
  text += fmt::format("delay_us = {:.2f}\n", delay->value * 1e3);
  if (const probe::Calibrated* const spread = result.find("delay_spread"))
    text += fmt::format("delay_spread_us = {:.2f}\n", spread->value * 1e3);
  return text;
}

void run_cal(CalArguments& arguments) {
  static const std::map<std::string, probe::CalibrationArtefact> kArtefacts = {
      {"block", probe::CalibrationArtefact::kBlock},
      {"ring", probe::CalibrationArtefact::kRing},
      {"sphere", probe::CalibrationArtefact::kSphere}};
  arguments.setup.artefact = kArtefacts.at(arguments.artefact);
  arguments.setup.outlier_level = arguments.outlier_level;
  if (arguments.ball_radius > 0) arguments.setup.ball_radius_mm = arguments.ball_radius;
  if (arguments.clearance > 0) arguments.setup.clearance_mm = arguments.clearance;
  if (arguments.overtravel > 0) arguments.setup.overtravel_mm = arguments.overtravel;
  probe::TouchTable table = read_table(arguments);
  const probe::ProbeCalibration result = probe::calibrate_probe(table, arguments.setup);
  std::optional<probe::GroupComparison> groups;
  if (!arguments.group.empty())
    groups = probe::compare_groups(table, arguments.setup, arguments.group, result);
  if (!arguments.output.empty()) {
    if (!result.delay_found)
      throw text::LimitNotMet(fmt::format("the touches do not determine the delay; no file is written: {}",
                                          result.findings.front()));
    text::write_file(arguments.output, board_lines(result));
  }
  Json json = {{"artefact", arguments.artefact},           {"n_touches", table.rows()},
               {"n_excluded", result.fit.outliers.size()}, {"rms_um", result.fit.rms * 1e3},
               {"delay_identified", result.delay_found},   {"parameters", json_of(result.parameters)}};
  const probe::Calibrated* const delay = result.find("delay");
  json["delay_ms"] = delay ? Json(delay->value) : Json();
  json["delay_std_ms"] = delay ? Json(delay->std) : Json();
  if (result.line_slope_um_per_mm_min)
    json["line"] = {{"intercept_um", *result.line_intercept_um},
                    {"intercept_std_um", *result.line_intercept_std_um},
                    {"slope_um_per_mm_min", *result.line_slope_um_per_mm_min},
                    {"slope_std", *result.line_slope_std}};
  json["outliers"] = json_of(result.fit, table);
  json["findings"] = result.findings;
  if (groups) json["groups"] = json_of(*groups, arguments.group);
  write_json(arguments.json, json);
  std::FILE* const out = human_stream(arguments.json);
  fmt::print(out, "{} touches of a {}, {} left out, rms {:.2f} um\n", table.rows(), arguments.artefact,
             result.fit.outliers.size(), result.fit.rms * 1e3);
  if (result.line_slope_um_per_mm_min)
    fmt::print(out, "  difference = {:.3f} {:+.5f} F um (F in mm/min)\n", *result.line_intercept_um,
               *result.line_slope_um_per_mm_min);
  print(out, result.parameters, result.findings);
  if (groups) print(out, *groups, arguments.group);
}

// ---- probe-path

struct PathArguments {
  std::string artefact, dialect, output;
  probe::ProbePath path;
  double size = 0;
  std::string unit = "mm";
};

void run_path(PathArguments& arguments) {
  static const std::map<std::string, probe::Dialect> kDialects = {{"turning", probe::Dialect::kTurning},
                                                                  {"linuxcnc", probe::Dialect::kLinuxcnc},
                                                                  {"fanuc", probe::Dialect::kFanuc},
                                                                  {"aerobasic", probe::Dialect::kAerobasic}};
  arguments.path.sphere = arguments.artefact == "sphere";
  arguments.path.radius = arguments.size / 2;
  arguments.path.inch = arguments.unit == "in";
  text::write_file(arguments.output, probe::probe_program(arguments.path, kDialects.at(arguments.dialect)));
  fmt::print("{}: {}\n", arguments.output, arguments.path.title);
}

// ---- feature

struct FeatureArguments : TableArguments {
  std::string kind, output;
  probe::FeatureSetup setup;
  std::vector<double> size;
  double expansion = 0, temperature = 0, expansion_std = 1, temperature_std = 0.1;
};

void run_feature(FeatureArguments& arguments, const CLI::App& command) {
  static const std::map<std::string, probe::FeatureKind> kKinds = {
      {"plane", probe::FeatureKind::kPlane},       {"line", probe::FeatureKind::kLine},
      {"circle", probe::FeatureKind::kCircle},     {"sphere", probe::FeatureKind::kSphere},
      {"cylinder", probe::FeatureKind::kCylinder}, {"block", probe::FeatureKind::kBlock}};
  probe::FeatureSetup& setup = arguments.setup;
  setup.kind = kKinds.at(arguments.kind);
  setup.outlier_level = arguments.outlier_level;
  if (arguments.size.size() == 2) setup.block_size_mm = {arguments.size[0], arguments.size[1]};
  if (command.count("--expansion") > 0) setup.expansion_per_K = arguments.expansion * 1e-6;
  if (command.count("--temperature") > 0) setup.temperature_degC = arguments.temperature;
  setup.expansion_std_per_K = arguments.expansion_std * 1e-6;
  setup.temperature_std_K = arguments.temperature_std;
  probe::TouchTable table = read_table(arguments);
  const probe::MeasuredFeature feature = probe::fit_feature(table, setup);
  if (!arguments.output.empty()) text::write_file(arguments.output, probe::feature_csv(table, feature));
  write_json(arguments.json, {{"feature", arguments.kind},
                              {"n_touches", table.rows()},
                              {"n_excluded", feature.fit.outliers.size()},
                              {"rms_um", feature.fit.rms * 1e3},
                              {"form_um", feature.form_mm * 1e3},
                              {"parameters", json_of(feature.parameters)},
                              {"outliers", json_of(feature.fit, table)},
                              {"findings", feature.findings}});
  std::FILE* const out = human_stream(arguments.json);
  fmt::print(out, "{} through {} touches, {} left out: rms {:.2f} um, form {:.2f} um\n", arguments.kind,
             table.rows(), feature.fit.outliers.size(), feature.fit.rms * 1e3, feature.form_mm * 1e3);
  print(out, feature.parameters, feature.findings);
}

}  // namespace

void register_probe_cal(CLI::App& vernier) {
  const auto arguments = std::make_shared<CalArguments>();
  CLI::App* const command = vernier.add_subcommand(
      "probe-cal", "Calibrate a touch probe on a known artefact: delay, pretravel, effective tip radius");
  add_table(*command, *arguments);
  command
      ->add_option("--artefact", arguments->artefact,
                   "artefact: block (touched on both faces), ring (inside), sphere (outside)")
      ->default_val("block")
      ->check(CLI::IsMember({"block", "ring", "sphere"}));
  command->add_option("--size", arguments->setup.size_mm, "mm; block: length; ring, sphere: diameter")
      ->required();
  command->add_option("--ball-radius", arguments->ball_radius, "nominal radius of the stylus ball, mm");
  command->add_option("--group", arguments->group,
                      "column with the groups of the touches, such as the angle of the probe: the command "
                      "evaluates each group separately and compares the groups");
  command->add_option("--clearance", arguments->clearance,
                      "approach distance of the touches, mm; the command reports touches at which the speed "
                      "was not yet constant");
  command->add_option("--overtravel", arguments->overtravel,
                      "distance of the programmed end of the approach beyond the surface, mm");
  add_conditions(*command, arguments->setup.conditions);
  command->add_option("-o", arguments->output, "output file: the delay as lines of a board file")
      ->type_name(kWrites);
  command->footer(
      "Columns: feed[mm/min]; block: upper, lower; ring, sphere: x, y, z, and a[mm/s^2] if an approach was "
      "not at\n"
      "constant feed; u. Exit status: 0 done, 1 bad input, 2 -o was given, but the touches do not determine "
      "the delay.");
  command->callback([arguments] { run_cal(*arguments); });
}

void register_probe_path(CLI::App& vernier) {
  const auto arguments = std::make_shared<PathArguments>();
  probe::ProbePath& path = arguments->path;
  CLI::App* const command =
      vernier.add_subcommand("probe-path", "Write the program of a probe calibration for a controller");
  command->add_option("artefact", arguments->artefact, "sphere | block")
      ->required()
      ->check(CLI::IsMember({"sphere", "block"}));
  command->add_option("--dialect", arguments->dialect, "turning (NISTIR 6415), linuxcnc, fanuc, aerobasic")
      ->required()
      ->check(CLI::IsMember({"turning", "linuxcnc", "fanuc", "aerobasic"}));
  command
      ->add_option("--size", arguments->size,
                   "size of the artefact, mm: diameter of the sphere, length of the block")
      ->required();
  command
      ->add_option("--clearance", path.clearance, "distance from the surface at which an approach begins, mm")
      ->required();
  command
      ->add_option("--overtravel", path.overtravel,
                   "distance of the programmed end of an approach beyond the surface, mm")
      ->capture_default_str();
  command->add_option("--ball-radius", path.ball_radius, "of the stylus, mm")->capture_default_str();
  command->add_option("--from", path.from_deg, "first angle, deg")->capture_default_str();
  command->add_option("--to", path.to_deg, "last angle, deg")->capture_default_str();
  command->add_option("--step", path.step_deg, "deg")->capture_default_str();
  command
      ->add_option(
          "--elevation", path.elevations_deg,
          "elevations of further circles of touches on the sphere, deg above the equator; 90 is the pole")
      ->delimiter(',');
  command->add_option("--feeds", path.feeds, "feeds of the approaches, in the unit of the program per minute")
      ->delimiter(',')
      ->required();
  command->add_option("--repeats", path.repeats, "number of touches on each face of the block")
      ->check(CLI::Range(1, 10000));
  command->add_option("--unit", arguments->unit, "of the program")
      ->check(CLI::IsMember({"mm", "in"}))
      ->capture_default_str();
  add_conditions(*command, path.conditions);
  command->add_flag("--unchecked", path.unchecked, "write the program even if a touch would not be valid");
  command->add_option("--name", path.name, "of the program")->capture_default_str();
  command->add_option("--title", path.title, "")->capture_default_str();
  command
      ->add_option("--centre", path.centre_offset,
                   "dialect turning: distance from the program's zero to the axis of the spindle, on which "
                   "the sphere is, in the unit of the program")
      ->capture_default_str();
  command
      ->add_option("--dwell", path.dwell,
                   "dialect turning: dwell after a touch; the program has this number, unchanged, in G04 X, "
                   "and the control defines its unit")
      ->capture_default_str();
  command
      ->add_option("--comment", path.comments,
                   "comment line at the top of the program; repeat the option for each line")
      ->allow_extra_args(false);
  command->add_option("-o", arguments->output, "program")->type_name(kWrites)->required();
  command->footer(
      "Exit status: 0 written, 1 bad input, 2 touches at this feed, approach or overtravel would not be "
      "valid "
      "(nothing written).");
  command->callback([arguments] { run_path(*arguments); });
}

void register_feature(CLI::App& vernier) {
  const auto arguments = std::make_shared<FeatureArguments>();
  CLI::App* const command = vernier.add_subcommand(
      "fit-feature", "Fit a plane, line, circle, sphere, cylinder or block to touches, with uncertainties");
  command->add_option("kind", arguments->kind, "plane | line | circle | sphere | cylinder | block")
      ->required()
      ->check(CLI::IsMember({"plane", "line", "circle", "sphere", "cylinder", "block"}));
  add_table(*command, *arguments);
  command->add_option("--ball-radius", arguments->setup.ball_radius_mm,
                      "effective radius of the stylus ball, mm (a result of probe-cal)");
  command->add_flag("--inside", arguments->setup.inside,
                    "the feature was touched from inside (for rows without normals)");
  command->add_option("--size", arguments->size, "block: X,Y in mm")->delimiter(',')->expected(2);
  command->add_option(
      "--expansion", arguments->expansion,
      "thermal expansion coefficient of the workpiece, um/(m K); the results are then sizes at 20 degC");
  command->add_option("--temperature", arguments->temperature,
                      "temperature of all rows, degC, if the file has no column T");
  command
      ->add_option("--expansion-std", arguments->expansion_std,
                   "standard uncertainty of the expansion coefficient, um/(m K)")
      ->capture_default_str();
  command->add_option("--temperature-std", arguments->temperature_std, "K")->capture_default_str();
  command
      ->add_option("-o", arguments->output,
                   "output file: the touches as a measurement file, with the distance d of each touch from "
                   "the feature along nx ny nz")
      ->type_name(kWrites);
  command->footer("Columns: x, y, z; nx, ny, nz (outward normals; a block: of the face); T[degC]; u.");
  command->callback([arguments, command] { run_feature(*arguments, *command); });
}

}  // namespace vernier::commands::probe_cli
