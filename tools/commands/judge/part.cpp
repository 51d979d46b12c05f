// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>

#include "tools/commands/command.h"
#include "tools/commands/judge/part_kinds.h"
#include "tools/commands/report_header.h"
#include "tools/evaluate/judgement.h"
#include "tools/format/csv_file.h"
#include "tools/kinematics/at.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/part/gauge_block.h"
#include "tools/part/measured_part.h"
#include "tools/part/part_json.h"
#include "tools/part/part_report.h"
#include "tools/part/surface/s_part.h"
#include "tools/part/surface/spline_program.h"
#include "tools/report/report.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::commands::part_cli {
namespace {

struct Arguments {
  std::string machine, errors, identify, free, output, json;
  std::string recorded, recorded_zero;
  double tool_diameter_mm = 20, tool_length_mm = 35, feed_mm_min = 1000, step_mm = 0.5;
  part::ToolPath tool_path = part::ToolPath::kAnalytical;
  part::DefectReading reading = part::DefectReading::kContact;
  ReportHeader header;
  part::RotarySolution solution = part::RotarySolution::kContinuous;
  bool aligned = false, tool_radius = false;
  double tolerance_mm = 0, u95_mm = 0;  // width of the zone; of the machine that measured the part
};

struct GaugeArguments {
  std::string file, json;
  double pivot_mm = 0;
};

/// Leaves only the named statics free.
void free_only(model::Machine& machine, const std::string& names) {
  std::set<std::size_t> wanted;
  for (const std::string& name : text::words_in(names, ", ")) {
    const auto index = machine.find_static(name);
    if (!index)
      throw text::InputError({"--free", 0}, name, fmt::format("no static has this name in {}", machine.name));
    wanted.insert(*index);
  }
  for (std::size_t i = 0; i < machine.statics.size(); ++i) {
    model::Static& item = machine.statics[i];
    if (!item.hidden && !item.nominal) item.nominal = item.value;
    item.hidden = !wanted.contains(i);
  }
}

part::RecordedPath recorded_of(const Arguments& arguments, const part::BHeadMachine& machine) {
  const model::States zero = kinematics::state_at(machine.machine, arguments.recorded_zero);
  const auto at = [&](std::size_t k) { return zero.axis[machine.axis[k]][0]; };
  return part::read_recorded(text::read_file(arguments.recorded), arguments.recorded,
                             {at(0), at(1), at(2), at(3), at(4)});
}

part::PartJob make_job(const Arguments& arguments, const std::string& machine_text) {
  part::PartJob job;
  model::Machine machine =
      model::parse_machine(machine_text, arguments.machine.empty() ? "built-in machine" : arguments.machine);
  part::set_errors(machine, arguments.errors);
  if (!arguments.free.empty()) free_only(machine, arguments.free);
  job.machine = part::b_head_machine(std::move(machine));
  job.options = {
      {arguments.tool_diameter_mm / 2, arguments.tool_length_mm, part::touch_of(arguments.tool_path)},
      arguments.reading,
      arguments.solution};
  for (const part::RuledSurface& flank : part::s_part()) part::check_cutter(flank, job.options.cutter);
  const part::PathOptions path{job.options.cutter, arguments.step_mm, arguments.feed_mm_min,
                               arguments.solution};
  for (std::size_t flank = 0; flank < part::s_part().size(); ++flank)
    job.paths.push_back(part::part_path(job.machine, flank, path));
  job.points = part::standard_points();
  if (!arguments.identify.empty()) {
    job.measured = part::read_measured_part(text::read_file(arguments.identify), arguments.identify);
    job.points.clear();
    for (const part::MeasuredPoint& point : job.measured->points) job.points.push_back(point.at);
    job.identified =
        part::identify(job.machine, *job.measured, {job.options, arguments.aligned, arguments.tool_radius});
    job.machine.machine = job.identified->machine;
  }
  job.defect = part::part_defect(job.machine, job.points, job.options);
  if (!arguments.recorded.empty())
    job.recorded = part::recorded_deviations(job.machine, recorded_of(arguments, job.machine), job.points,
                                             job.options.cutter);
  return job;
}

void print_summary(std::FILE* out, const nlohmann::ordered_json& result) {
  const auto& d = result["defect"];
  fmt::print(out, "defect at {} points ({}): {:.4f} to {:.4f} mm\n", d["points"].get<int>(),
             d["reading"].get<std::string>(), d["min_mm"].get<double>(), d["max_mm"].get<double>());
  for (const auto& one : result["overcut"])
    fmt::print(out,
               "overcut of flank {} at its foot: formula {:.4f} mm as printed, {:.4f} mm with unit normal; "
               "distance {:.4f} mm, {:.4f} mm at its top\n",
               one["flank"].get<std::string>(), one["formula_as_printed"]["mm"].get<double>(),
               one["formula_unit_normal"]["mm"].get<double>(), one["distance"][0]["mm"].get<double>(),
               one["distance"].back()["mm"].get<double>());
  if (result.contains("recorded"))
    for (const char* kind : {"recorded", "path", "controller"})
      fmt::print(out, "{} at {} points: {:+.4f} to {:+.4f} mm, rms {:.4g} um\n", kind,
                 result["recorded"]["points"].get<int>(), result["recorded"][kind]["min_mm"].get<double>(),
                 result["recorded"][kind]["max_mm"].get<double>(),
                 result["recorded"][kind]["rms_um"].get<double>());
  for (const auto& path : result["paths"])
    for (const auto& beyond : path["beyond_limits"])
      fmt::print(out, "flank {}: {}\n", path["flank"].get<std::string>(), beyond.get<std::string>());
  for (const auto& one : result["observability"])
    fmt::print(out, "{}: rank {} of {}, inseparable {}\n", one["reading"].get<std::string>(),
               one["rank"].get<int>(), one["parameters"].get<int>(),
               part::joined_groups(one["unidentifiable"]));
  if (!result.contains("parameters")) return;
  fmt::print(out, "rms {:.4g} -> {:.4g} um\n", result["rms_before_um"].get<double>(),
             result["rms_um"].get<double>());
  for (const auto& p : result["parameters"])
    fmt::print(out, "  {:11} {:12.5g} +- {:9} {}\n", p["name"].get<std::string>(), p["value"].get<double>(),
               p["std"].is_null() ? "-" : fmt::format("{:.2g}", p["std"].get<double>()),
               p["unit"].get<std::string>());
}

/// A profile tolerance is a zone about the true surface, half of it on either side (ISO 1101). The result is
/// met, not met or not decided by ISO 14253-1, with the uncertainty of the measuring machine. Evaluates the
/// measured points, else the predicted points.
nlohmann::ordered_json judged(const Arguments& arguments, const part::PartJob& job,
                              const nlohmann::ordered_json& defect) {
  evaluate::Conformity worst = evaluate::Conformity::kMet;
  double farthest = 0, u95 = 0;
  std::size_t line = 0;
  const auto take = [&](double defect_mm, double point_u95_mm, std::size_t at) {
    const evaluate::Conformity one =
        evaluate::conformity(2 * std::abs(defect_mm), arguments.tolerance_mm, 2 * point_u95_mm);
    if (one == evaluate::Conformity::kNotMet || worst == evaluate::Conformity::kMet) worst = one;
    u95 = std::max(u95, point_u95_mm);
    if (std::abs(defect_mm) <= std::abs(farthest)) return;
    farthest = defect_mm, line = at;
  };
  if (job.measured) {
    for (const part::MeasuredPoint& point : job.measured->points)
      take(point.defect_mm, std::max(arguments.u95_mm, 2 * point.uncertainty_mm), point.line);
  } else {
    for (const char* end : {"min_mm", "max_mm"}) take(defect[end].get<double>(), arguments.u95_mm, 0);
  }
  return {{"zone_mm", arguments.tolerance_mm},
          {"of", job.measured ? "measured" : "predicted"},
          {"farthest_mm", farthest},
          {"line", job.measured ? nlohmann::ordered_json(line) : nlohmann::ordered_json(nullptr)},
          {"u95_mm", u95},
          {"conformity", evaluate::conformity_text(worst)}};
}

void say_judged(std::FILE* out, const nlohmann::ordered_json& tolerance) {
  const std::string words =
      fmt::format("tolerance zone of {:g} mm, farthest {} point {:+.4f} mm, U {:.2g} mm: {}",
                  tolerance["zone_mm"].get<double>(), tolerance["of"].get<std::string>(),
                  tolerance["farthest_mm"].get<double>(), tolerance["u95_mm"].get<double>(),
                  tolerance["conformity"].get<std::string>());
  if (tolerance["conformity"] == evaluate::conformity_text(evaluate::Conformity::kNotMet))
    throw text::LimitNotMet(words);
  fmt::print(out, "{}\n", words);
}

void run_s_shape(const Arguments& arguments) {
  const std::string machine_text =
      arguments.machine.empty() ? part::default_b_head_text() : text::read_file(arguments.machine);
  const part::PartJob job = make_job(arguments, machine_text);
  nlohmann::ordered_json result = part::part_json(job);
  if (arguments.tolerance_mm > 0) result["tolerance"] = judged(arguments, job, result["defect"]);
  const part::PathOptions path{job.options.cutter, arguments.step_mm, arguments.feed_mm_min,
                               arguments.solution};
  // Parameters that are fixed in this run remain free in the file.
  model::Machine written = model::parse_machine(machine_text, arguments.machine);
  for (std::size_t i = 0; i < written.statics.size(); ++i)
    written.statics[i].value = job.machine.machine.statics[i].value;
  // Makes all texts first: after a failure no file is written.
  std::vector<std::pair<std::string, std::string>> files = {
      {"defect.csv", part::defect_csv(job.points, job.defect)},
      {"machine.xml", model::update_machine_text(machine_text, written, true)},
      {"report.html", report::improvement_report_html(arguments.header.on(part::part_report(job, result)))}};
  if (arguments.tool_path == part::ToolPath::kTp5c1)
    files.emplace_back("TP5C1.mpf", part::spline_program(0, part::kPartHeightMm));
  if (arguments.tool_path == part::ToolPath::kTp6c2)
    files.emplace_back("TP6C2.mpf",
                       part::spline_program(part::kMeasuredHeightsMm[0], part::kMeasuredHeightsMm[1]));
  if (job.recorded)
    files.emplace_back("recorded.csv", part::recorded_csv(job.points, job.defect, *job.recorded));
  for (const part::PartPath& one : job.paths) {
    const char flank = part::s_part()[one.flank].name;
    files.emplace_back(fmt::format("path_{}.csv", flank), part::path_csv(job.machine, one));
    files.emplace_back(fmt::format("path_{}.nc", flank), part::path_gcode(one, path));
  }
  text::make_folder(arguments.output);
  for (const auto& [name, text] : files)
    text::write_file((std::filesystem::path(arguments.output) / name).string(), text);
  write_json(arguments.json, result);
  print_summary(human_stream(arguments.json), result);
  if (job.identified)
    for (const std::string& warning : job.identified->warnings)
      fmt::print(stderr, "vernier: warning: {}\n", warning);
  if (arguments.tolerance_mm > 0) say_judged(human_stream(arguments.json), result["tolerance"]);
}

/// Columns C[deg] and y[mm]; one row each for 0, 90, 180 and 270 deg.
std::array<double, 4> read_gauge_block(const std::string& file) {
  const format::CsvFile csv = format::parse_csv(text::read_file(file), file);
  const auto column = [&](const char* name, const char* unit) {
    for (std::size_t i = 0; i < csv.columns.size(); ++i)
      if (csv.columns[i].name == name && csv.columns[i].unit == unit) return i;
    throw text::InputError(
        {file, csv.header_line}, name,
        fmt::format("the file of gauge block readings needs the column {}[{}]", name, unit));
  };
  const std::size_t c = column("C", "deg"), y = column("y", "mm");
  std::array<std::optional<double>, 4> found;
  for (std::size_t row = 0; row < csv.rows.size(); ++row) {
    const text::Place place{file, csv.line[row]};
    const auto angle = text::parse_number(csv.rows[row][c]), reading = text::parse_number(csv.rows[row][y]);
    if (!angle || !reading)
      throw text::InputError(place, angle ? csv.rows[row][y] : csv.rows[row][c], "not a number");
    const double quarter = *angle / 90;
    if (!(quarter >= 0 && quarter <= 3) || quarter != std::floor(quarter))
      throw text::InputError(place, csv.rows[row][c], "C must be 0, 90, 180 or 270");
    auto& slot = found[static_cast<std::size_t>(quarter)];
    if (slot)
      throw text::InputError(place, csv.rows[row][c], "the file has two readings at this position of C");
    slot = *reading;
  }
  std::array<double, 4> y_mm{};
  for (std::size_t i = 0; i < 4; ++i) {
    if (!found[i])
      throw text::InputError({file, 0}, std::to_string(90 * i),
                             "the file has no reading at this position of C");
    y_mm[i] = *found[i];
  }
  return y_mm;
}

void run_gauge_block(const GaugeArguments& arguments) {
  const part::GaugeBlockEstimate found =
      part::estimate_gauge_block(read_gauge_block(arguments.file), arguments.pivot_mm);
  write_json(arguments.json, {{"EA0B_rad", found.ea0b_rad},
                              {"EX0B_mm", found.ex0b_mm},
                              {"EA0B_rad_per_um", found.ea0b_per_mm / 1000},
                              {"EX0B_mm_per_um", found.ex0b_per_mm / 1000}});
  std::FILE* out = human_stream(arguments.json);
  fmt::print(out, "EA0B {:.4g} rad ({:.2g} rad per um of a reading)\n", found.ea0b_rad,
             found.ea0b_per_mm / 1000);
  fmt::print(out, "EX0B {:.4g} mm\n", found.ex0b_mm);
}

void add_s_shape(CLI::App& part) {
  auto a = std::make_shared<Arguments>();
  CLI::App* command = part.add_subcommand(
      "s-shape",
      "The S-shaped test part of ISO 10791-7: path, predicted defect, and the machine's errors from it");
  command->add_option("--machine", a->machine, "machine file with B head and C table (default: built in)")
      ->type_name(kReads)
      ->check(CLI::ExistingFile);
  command->add_option("--errors", a->errors, "statics to set, e.g. \"EA0B=3.2e-4rad,EX0B=0.03\"");
  command->add_option("--tool-diameter", a->tool_diameter_mm, "mm")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--tool-length", a->tool_length_mm,
                   "distance of the tool tip below the top of the part, mm")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--feed", a->feed_mm_min, "mm/min on the top curve")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--step", a->step_mm,
                   "largest distance between two positions of the path on the top curve, mm")
      ->capture_default_str()
      ->check(CLI::Range(0.005, 20.0));
  command
      ->add_option("--reading", a->reading,
                   "point at which the defect is evaluated: contact, tip (as in the paper) or in-plane")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, part::DefectReading>{{"contact", part::DefectReading::kContact},
                                                     {"tip", part::DefectReading::kTip},
                                                     {"in-plane", part::DefectReading::kInPlane}}));
  command->add_option("--rotary", a->solution, "continuous or positive-b: which solution of the rotary axes")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, part::RotarySolution>{{"continuous", part::RotarySolution::kContinuous},
                                                      {"positive-b", part::RotarySolution::kPositiveB}}));
  command
      ->add_option("--tool-path", a->tool_path,
                   "path of the cutter: analytical, TP5C1 or TP6C2; the cutter touches the flank at the top, "
                   "at the foot, or at Z = 11 mm")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, part::ToolPath>{{"analytical", part::ToolPath::kAnalytical},
                                                {"TP5C1", part::ToolPath::kTp5c1},
                                                {"TP6C2", part::ToolPath::kTp6c2}}));
  CLI::Option* recorded_option =
      command
          ->add_option("--recorded", a->recorded,
                       "positions that the controller recorded (CSV: X Y Z B C); the command computes their "
                       "effect on the defect at each point")
          ->type_name(kReads);
  command
      ->add_option("--recorded-zero", a->recorded_zero,
                   "recorded values at which the axes of the paths are at 0: \"X=120,Z=-40\"")
      ->needs(recorded_option);
  CLI::Option* identify_option = command
                                     ->add_option("--identify", a->identify,
                                                  "measured part (CSV: sx sy sz defect, u): fit the errors "
                                                  "of the machine to the measured defects")
                                     ->type_name(kReads);
  command->add_option(
      "--free", a->free,
      "names of the constants (statics) that are fitted, e.g. EA0B,EX0B; all others are fixed");
  command
      ->add_flag("--aligned", a->aligned, "the measured part was aligned by best fit: fit a rigid motion too")
      ->needs(identify_option);
  command->add_flag("--tool-radius", a->tool_radius, "fit the error of the tool radius too")
      ->needs(identify_option);
  command
      ->add_option("--tolerance", a->tolerance_mm,
                   "width of the tolerance zone of the part's surface, mm (0.12); exit status 2 if the "
                   "surface is outside the zone")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--uncertainty", a->u95_mm,
                   "expanded uncertainty (k = 2) of the machine that measured the part, mm")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option(
          "-o,--output", a->output,
          "output directory for the paths (CSV, G-code), the defect, the machine file and the report")
      ->type_name(kWritesFolder)
      ->required();
  add_report_header(*command, a->header);
  command->add_option("--json", a->json, "file for the result as JSON, for programs; - for standard output");
  command->callback([a] { run_s_shape(*a); });
}

void add_gauge_block(CLI::App& part) {
  auto a = std::make_shared<GaugeArguments>();
  CLI::App* command = part.add_subcommand(
      "gauge-block",
      "compute EA0B and EX0B from readings of a gauge block along Y at C = 0, 90, 180, 270 deg");
  command->add_option("FILE", a->file, "CSV with C[deg] and y[mm]")->type_name(kReads)->required();
  command->add_option("--pivot-length", a->pivot_mm, "distance from the B axis to the tool tip, mm")
      ->required()
      ->check(CLI::PositiveNumber);
  command->add_option("--json", a->json, "file for the result as JSON, for programs; - for standard output");
  command->callback([a] { run_gauge_block(*a); });
}

}  // namespace

void register_part(CLI::App& vernier) {
  CLI::App* part =
      vernier.add_subcommand("part", "Predict whether a part is within tolerance; evaluate test parts");
  part->require_subcommand(1);
  add_s_shape(*part);
  add_gauge_block(*part);
  add_conformity(*part);
}

}  // namespace vernier::commands::part_cli
