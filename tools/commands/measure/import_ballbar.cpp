// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/measure/import_kinds.h"
#include "tools/import/ballbar/b5r_reader.h"
#include "tools/import/ballbar/ballbar_csv.h"
#include "tools/import/ballbar/ballbar_file.h"
#include "tools/import/ballbar/ballbar_motion.h"
#include "tools/import/ballbar/printed_results.h"
#include "tools/import/ballbar/repair_report.h"
#include "tools/import/ballbar/trace_reader.h"
#include "tools/text/error.h"
#include "tools/text/optional_json.h"

namespace vernier::commands::import_cli {
namespace {

using Json = nlohmann::ordered_json;

Json hysteresis_json(const std::optional<importer::Hysteresis>& hysteresis) {
  return hysteresis ? Json{{"um", hysteresis->um}, {"deg", hysteresis->deg}} : Json(nullptr);
}

Json circle_json(const importer::BallbarFile& file, const importer::CircularResult& circle) {
  Json runs = Json::array();
  for (const auto& pass : circle.passes) {
    runs.push_back({{"label", pass.label},
                    {"direction", pass.direction},
                    {"centre_mm", {pass.centre_a_mm, pass.centre_b_mm}},
                    {"radius_mm", pass.radius_mm},
                    {"circular_deviation_um", pass.circular_deviation_um},
                    {"max_circular_um", pass.max_circular_um},
                    {"min_circular_um", pass.min_circular_um},
                    {"max_radial_um", pass.max_radial_um},
                    {"max_radial_deg", pass.max_deg},
                    {"min_radial_um", pass.min_radial_um},
                    {"min_radial_deg", pass.min_deg},
                    {"feed_mm_min", text::or_null(pass.feed_mm_min)}});
  }
  return {{"file", file.path},
          {"plane", {file.axis_a, file.axis_b}},
          {"nominal_radius_mm", circle.nominal_radius_mm},
          {"runs", runs},
          {"bidirectional_um", text::or_null(circle.bidirectional_um)},
          {"non_roundness_um",
           circle.about_mean ? Json(circle.about_mean->max_um - circle.about_mean->min_um) : Json(nullptr)},
          {"mean_bidirectional_radial_um", text::or_null(circle.mean_bidirectional_radial_um)},
          {"hysteresis", hysteresis_json(circle.hysteresis)},
          {"hysteresis_by_angle", hysteresis_json(circle.hysteresis_by_angle)}};
}

Json printed_json(const std::vector<importer::PrintedResult>& results) {
  Json list = Json::array();
  for (const auto& result : results) {
    list.push_back({{"place", result.place},
                    {"name", result.name},
                    {"unit", result.unit},
                    {"printed", result.printed},
                    {"computed", text::or_null(result.computed)},
                    {"equal", result.equal},
                    {"from", result.from.empty() ? Json(nullptr) : Json(result.from)},
                    {"why", result.why.empty() ? Json(nullptr) : Json(result.why)}});
  }
  return list;
}

// How many of the printed results are computed here to their last digit, from what, and which are not and
// why.
void print_printed(std::FILE* out, const std::vector<importer::PrintedResult>& results) {
  if (results.empty()) return;
  std::map<std::string, std::size_t> equal;
  std::map<std::string, std::string> others;
  std::size_t all = 0;
  for (const auto& result : results) {
    if (result.equal) {
      ++all, ++equal[result.from];
      continue;
    }
    std::string& names = others[result.why];
    names += (names.empty() ? "" : ", ") + result.name;
    if (result.computed)
      names += fmt::format(" (printed {}, computed {:.4g})", result.printed, *result.computed);
  }
  std::string from;
  for (const auto& [what, count] : equal)
    from += fmt::format("{}{} from {}", from.empty() ? "" : ", ", count, what);
  fmt::print(out, "{} of the {} results that the files print are recomputed to the last digit: {}\n", all,
             results.size(), from);
  for (const auto& [why, names] : others) fmt::print(out, "  not {}: {}\n", names, why);
}

void print_circle(std::FILE* out, const importer::BallbarFile& file, const importer::CircularResult& circle) {
  fmt::print(out, "{}: {}{} plane, radius {} mm\n", file.path, file.axis_a, file.axis_b,
             circle.nominal_radius_mm);
  for (const auto& pass : circle.passes) {
    fmt::print(out,
               "  {:<4} centre {:.4f} {:.4f} mm  radius {:.4f} mm  circular deviation {:.1f} um  feed {:.1f} "
               "mm/min\n",
               pass.label, pass.centre_a_mm, pass.centre_b_mm, pass.radius_mm, pass.circular_deviation_um,
               pass.feed_mm_min.value_or(0));
  }
  if (circle.bidirectional_um && circle.hysteresis) {
    fmt::print(out, "  bidirectional {:.1f} um  hysteresis {:.1f} um at {:.3f} deg\n",
               *circle.bidirectional_um, circle.hysteresis->um, circle.hysteresis->deg);
  }
}

// Shorter than a quarter, an arc fixes neither its centre nor its radius.
bool spans_a_circle(const importer::BallbarFile& file) {
  constexpr double kShortestArcDeg = 90;
  return std::all_of(file.runs.begin(), file.runs.end(), [](const importer::BallbarRun& run) {
    return run.last_deg - run.first_deg >= kShortestArcDeg;
  });
}

std::vector<importer::BallbarFile> repaired_files(const std::vector<importer::RepairReport>& repairs) {
  std::vector<importer::BallbarFile> files;
  for (const auto& report : repairs) files.push_back(report.repair.file);
  return files;
}

// Writes the CSV and reports its contents: the same for both kinds of file.
void write_import(const std::string& kind, const std::vector<importer::BallbarFile>& files,
                  const importer::BallbarCsvOptions& options, const ImportOutput& output,
                  bool repair = false) {
  std::FILE* out = human_stream(output.json_path);
  std::vector<importer::RepairReport> repairs;
  if (repair)
    std::transform(files.begin(), files.end(), std::back_inserter(repairs), importer::repair_and_judge);
  const importer::BallbarCsv csv = importer::ballbar_csv(repair ? repaired_files(repairs) : files, options);
  Json circles = Json::array(), notes = Json::array();
  std::vector<importer::PrintedResult> printed;
  std::string lines;
  for (const auto& file : files) {
    for (const auto& note : file.notes) notes.push_back(file.path + ": " + note);
    if (!spans_a_circle(file)) {
      notes.push_back(
          fmt::format("{}, {}{}: the arc is too short to compute centre, radius and circular deviation",
                      file.path, file.axis_a, file.axis_b));
      continue;
    }
    const importer::CircularResult circle =
        importer::analyse_circle(file.radius_mm, importer::circular_passes(file));
    circles.push_back(circle_json(file, circle));
    for (const auto& result : importer::printed_results(file, circle)) printed.push_back(result);
  }
  const auto equal = std::count_if(printed.begin(), printed.end(),
                                   [](const importer::PrintedResult& result) { return result.equal; });
  Json result = {{"kind", kind},
                 {"n_rows", csv.rows},
                 {"n_fit", csv.fit_rows},
                 {"n_check", csv.check_rows},
                 {"runs", csv.run_labels},
                 {"circular", circles},
                 {"n_printed", printed.size()},
                 {"n_printed_equal", equal},
                 {"printed", printed_json(printed)},
                 {"pause_s", options.pause_s},
                 {"notes", notes}};
  for (const auto& one : repairs) result["time_base_repair"].push_back(importer::repair_json(one));
  text::write_file(output.csv_path, csv.text);
  write_json(output.json_path, result);
  for (const auto& file : files) {
    if (spans_a_circle(file))
      print_circle(out, file, importer::analyse_circle(file.radius_mm, importer::circular_passes(file)));
  }
  for (const auto& one : repairs) importer::print_repair(out, one);
  print_printed(out, printed);
  for (const auto& note : notes) fmt::print(out, "note: {}\n", note.get<std::string>());
  fmt::print(out, "{}: {} rows ({} fit, {} check)\n", output.csv_path, csv.rows, csv.fit_rows,
             csv.check_rows);
}

struct BallbarArguments {
  std::vector<std::string> files;
  importer::BallbarCsvOptions options;
  ImportOutput output;
  importer::TraceSetup setup;  // ballbar-trace only
  std::vector<std::string> planes = {"XY"};
  std::vector<double> starts_deg = {180};
  std::string direction_of_zero = "ccw";
  bool repair = false;  // ballbar only
};

std::shared_ptr<BallbarArguments> add_common(CLI::App& kind) {
  auto arguments = std::make_shared<BallbarArguments>();
  kind.add_option("files", arguments->files, "Files of the instrument")->type_name(kReads)->required();
  kind.add_option(
          "--pause", arguments->options.pause_s,
          "Time from the end of a run to the start of the next run (s); the files do not contain this time")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e6));
  add_import_output(kind, arguments->output);
  return arguments;
}

std::vector<importer::TraceCircle> circles_of(const BallbarArguments& arguments) {
  const std::vector<std::string>& planes = arguments.planes;
  const std::vector<double>& starts_deg = arguments.starts_deg;
  if (starts_deg.size() != 1 && starts_deg.size() != planes.size())
    throw text::InputError(
        fmt::format("--start-angle: {} angles for {} planes", starts_deg.size(), planes.size()));
  std::vector<importer::TraceCircle> circles;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    // XY and YX are one circle.
    for (std::size_t j = 0; j < i; ++j)
      if (planes[j].find(planes[i][0]) != std::string::npos &&
          planes[j].find(planes[i][1]) != std::string::npos)
        throw text::InputError(fmt::format("--plane: {} and {} are the same plane", planes[j], planes[i]));
    circles.push_back({planes[i], starts_deg[starts_deg.size() == 1 ? 0 : i]});
  }
  return circles;
}

}  // namespace

void add_ballbar_kind(CLI::App& kind) {
  kind.footer(
      "Samples between START and END of the file are fit rows; the overshoot arcs before START and after END "
      "are check rows. With --repair-time-base the fit rows are the first whole turn on the circle; "
      "the other samples are check rows. Samples of the feed-in that no later pass repeats "
      "have no length.");
  const auto arguments = add_common(kind);
  kind.add_flag("--repair-time-base", arguments->repair,
                "Estimate the samples per turn and the missing samples from the record itself, and compute "
                "the angle and time of each sample again");
  kind.callback([arguments] {
    std::vector<importer::BallbarFile> files;
    for (const auto& path : arguments->files) files.push_back(importer::read_b5r(path));
    write_import("ballbar", files, arguments->options, arguments->output, arguments->repair);
  });
}

void add_ballbar_trace_kind(CLI::App& kind) {
  kind.footer(
      "A trace file contains only readings; give plane, radius, feed and start angle of the circle as "
      "options.");
  const auto arguments = add_common(kind);
  importer::TraceSetup& setup = arguments->setup;
  const CLI::Range positive(1e-6, 1e9);
  kind.add_option("--length", setup.length_mm, "Nominal length of the bar (mm)")->required()->check(positive);
  kind.add_option("--feed", setup.feed_mm_min, "Feed along the circle (mm/min)")->required()->check(positive);
  kind.add_option("--radius", setup.radius_mm,
                  "Radius of the programmed circle (mm); default: the bar's length")
      ->check(positive);
  kind.add_option("--plane", arguments->planes,
                  "Plane of the circle, first axis first (XY). For a path of several circles: all planes in "
                  "the order of the path, XY,YZ,ZX; the runs of all files belong to the planes in this "
                  "order, with the same number of runs for each plane")
      ->delimiter(',')
      ->check(CLI::IsMember({"XY", "YZ", "ZX", "YX", "ZY", "XZ"}));
  kind.add_option("--start-angle", arguments->starts_deg,
                  "Angle of the first reading, counted from the first axis to the second axis of the plane "
                  "(deg, 180): one value, or one value per plane")
      ->delimiter(',');
  kind.add_option("--rate", setup.sample_rate_hz, "Readings per second")
      ->capture_default_str()
      ->check(positive);
  kind.add_option("--direction-0", arguments->direction_of_zero,
                  "Direction of motion that the value Direction 0 of the file means")
      ->capture_default_str()
      ->check(CLI::IsMember({"ccw", "cw"}));
  kind.callback([arguments, &kind] {
    importer::TraceSetup trace = arguments->setup;
    if (kind.count("--radius") == 0) trace.radius_mm = trace.length_mm;
    trace.direction_of_zero = arguments->direction_of_zero == "ccw" ? +1 : -1;
    write_import("ballbar-trace",
                 importer::read_trace_circles(arguments->files, trace, circles_of(*arguments)),
                 arguments->options, arguments->output);
  });
}

}  // namespace vernier::commands::import_cli
