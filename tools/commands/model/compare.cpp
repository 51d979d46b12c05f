// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/commands/report_header.h"
#include "tools/commands/survey.h"
#include "tools/fit/convention.h"
#include "tools/fit/fit.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/set_up.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/report/report.h"
#include "tools/results/before_after_result.h"
#include "tools/results/detail.h"
#include "tools/results/field_json.h"
#include "tools/results/group_table.h"
#include "tools/results/limit.h"
#include "tools/results/residual_csv.h"
#include "tools/results/results.h"
#include "tools/results/structure_json.h"
#include "tools/simulate/corrected.h"
#include "tools/text/error.h"

namespace vernier::commands::compare_cli {
namespace {

struct CompareArguments {
  std::string machine, output, json, images, residuals, limit;
  std::vector<std::string> measurements, before, after, by;
  bool datum = false;
  ReportHeader header;
};

std::optional<double> value_of(const nlohmann::ordered_json& json, const char* key) {
  if (json[key].is_null()) return std::nullopt;
  return json[key].get<double>();
}

void print_circle(std::FILE* out, const nlohmann::ordered_json& circle) {
  fmt::print(out, "circle {}{}, nominal radius {:g} mm (ISO 230-4)\n", circle["plane"][0].get<std::string>(),
             circle["plane"][1].get<std::string>(), circle["nominal_radius_mm"].get<double>());
  for (const auto& run : circle["runs"]) {
    fmt::print(
        out,
        "  {:<5} circular deviation {:.1f} um, radial {:.1f} um at {:.3f} deg to {:.1f} um at {:.3f} deg\n",
        run["label"].get<std::string>(), run["circular_deviation_um"].get<double>(),
        run["max_radial_um"].get<double>(), run["max_radial_deg"].get<double>(),
        run["min_radial_um"].get<double>(), run["min_radial_deg"].get<double>());
    fmt::print(
        out, "        centre {:.4f} / {:.4f} mm, radius {:.4f} mm{}\n", run["centre_mm"][0].get<double>(),
        run["centre_mm"][1].get<double>(), run["radius_mm"].get<double>(),
        run["feed_mm_min"].is_null() ? ""
                                     : fmt::format(", feed {:.1f} mm/min", run["feed_mm_min"].get<double>()));
  }
  if (!circle["bidirectional_um"].is_null())
    fmt::print(out, "  bidirectional circular deviation {:.1f} um\n",
               circle["bidirectional_um"].get<double>());
  if (!circle["hysteresis_um"].is_null())
    fmt::print(out,
               "  hysteresis {:.1f} um at {:.3f} deg (samples paired by index), {:.1f} um at {:.3f} deg (by "
               "angle)\n",
               circle["hysteresis_um"].get<double>(), circle["hysteresis_deg"].get<double>(),
               circle["hysteresis_by_angle_um"].get<double>(),
               circle["hysteresis_by_angle_deg"].get<double>());
  if (circle["diagnostics"].is_null()) return;
  constexpr std::size_t kMost = 6;
  fmt::print(out,
             "  causes of the circular deviation, strongest first (effect on the radius, peak to peak)\n");
  for (std::size_t i = 0; i < std::min(kMost, circle["diagnostics"].size()); ++i) {
    const auto& one = circle["diagnostics"][i];
    fmt::print(out, "    {:<38} {:>9.3g} {:<5} {:>7.1f} um\n", one["name"].get<std::string>(),
               one["value"].get<double>(), one["unit"].get<std::string>(), one["effect_um"].get<double>());
  }
}

/// Useful if the rows of a run change roles and are few enough to read.
void print_stretches(std::FILE* out, const nlohmann::ordered_json& stretches) {
  constexpr std::size_t kMost = 12;
  if (stretches.size() < 2 || stretches.size() > kMost) return;
  for (const auto& s : stretches)
    fmt::print(out, "  run {:<6} {:<5} lines {} to {}: rms {:.4g} um\n", s["run"].get<std::string>(),
               s["role"].get<std::string>(), s["first_line"].get<std::size_t>(),
               s["last_line"].get<std::size_t>(), s["rms_um"].get<double>());
}

std::string percent(double share) { return fmt::format("{:.3g} %", 100 * share); }

/// Where the model fails, strongest first: sentences of the same JSON that the report draws.
void print_failure(std::FILE* out, const nlohmann::ordered_json& json) {
  constexpr std::size_t kMost = 8;
  const auto& findings = json["findings"];
  const auto& structure = json["structure"];
  const double chance = structure["omnibus_p"].get<double>();
  if (findings.empty()) {
    fmt::print(out, "where the model fails: {} ({} patterns tested, chance of the strongest {:.2g})\n",
               structure["no_findings"].get<std::string>(), structure["tried"].get<std::size_t>(), chance);
  } else {
    fmt::print(
        out,
        "where the model fails (share of the variance of the residual: alone, beyond the other findings)\n");
  }
  for (std::size_t i = 0; i < std::min(kMost, findings.size()); ++i)
    fmt::print(out, "  {:>7} {:>7}  {}\n", percent(findings[i]["share_alone"].get<double>()),
               percent(findings[i]["share_after"].get<double>()), findings[i]["sentence"].get<std::string>());
  if (findings.size() > kMost)
    fmt::print(out, "  {} further findings are in the report\n", findings.size() - kMost);
  if (!structure["pure_error_um"].is_null())
    fmt::print(out, "  repeated rows scatter by {:.4g} um; the lack of fit of the model is {:.4g} um\n",
               structure["pure_error_um"].get<double>(), structure["lack_of_fit_um"].get<double>());
  if (structure["outliers"].get<std::size_t>() > 0)
    fmt::print(out, "  {} readings differ by more than 5 robust standard deviations\n",
               structure["outliers"].get<std::size_t>());
}

void print_result(std::FILE* out, const nlohmann::ordered_json& json) {
  const auto error = [&](const std::string& what) {
    return results::error_or_dash(value_of(json, (what + "_um").c_str()),
                                  value_of(json, (what + "_urad").c_str()));
  };
  fmt::print(out, "rms fit rows    {}   max {}\n", error("rms"), error("max"));
  fmt::print(out, "rms check rows  {}   max {}\n", error("check_rms"), error("check_max"));
  if (const auto rotations = value_of(json, "rms_urad"); rotations && value_of(json, "rms_um"))
    fmt::print(out, "rms rotations   {}\n", results::number_or_dash(rotations, "urad"));
  fmt::print(out, "noise           {}\n", error("noise"));
  if (const auto& known = json["prediction_std_um"]; !known.is_null())
    fmt::print(out, "uncertainty of the model  {:.4g} um on average over these rows, {:.4g} um at most\n",
               known["rms"].get<double>(), known["max"].get<double>());
  if (const auto& tilt = json["tilt_deg"]; !tilt.is_null())
    fmt::print(out, "tool tilted by  {:.4g} deg on average by the modelled errors, {:.4g} deg at most\n",
               tilt["rms"].get<double>(), tilt["max"].get<double>());
  fmt::print(out, "{} readings, {} of them in check rows (held-out rows); {} rows excluded\n",
             json["n_obs"].get<std::size_t>() + json["n_check"].get<std::size_t>(),
             json["n_check"].get<std::size_t>(), json["n_excluded"].get<std::size_t>());
  print_stretches(out, json["stretches"]);
  for (const auto& circle : json["circular"]) print_circle(out, circle);
  print_failure(out, json);
}

void print_groups(std::FILE* out, const nlohmann::ordered_json& groups) {
  for (const auto& column : groups) {
    const auto& chance = column["differ_p"];
    fmt::print(out, "by {}: {}\n", column["column"].get<std::string>(),
               chance.is_null() ? "there are too few readings to decide whether the groups differ"
                                : fmt::format("probability that equal groups differ so much by chance {:.2g}",
                                              chance.get<double>()));
    for (const auto& group : column["each"])
      for (const auto& one : group["readings"])
        fmt::print(out, "  {:<16} {:<7} {:>6} readings  mean {:>9.4g}  rms {:>9.4g} {}\n",
                   group["value"].get<std::string>(), one["reading"].get<std::string>(),
                   one["n"].get<std::size_t>(), one["mean"].get<double>(), one["rms"].get<double>(),
                   one["unit"].get<std::string>());
  }
}

/// Accept or requalify. The exit status gives the same answer.
void judge(std::FILE* out, const nlohmann::ordered_json& limit) {
  const auto& worst = limit["worst"];
  const std::string words = fmt::format(
      "limit {} for the {}: {} of {} {} readings exceed the limit; the largest is {:.4g} with a limit of "
      "{:.4g} {} ({}:{})",
      limit["limit"].get<std::string>(), limit["of"].get<std::string>(), limit["beyond"].get<std::size_t>(),
      limit["rows"].get<std::size_t>(), limit["role"].get<std::string>(), worst["value"].get<double>(),
      worst["limit"].get<double>(), limit["unit"].get<std::string>(), worst["file"].get<std::string>(),
      worst["line"].get<std::size_t>());
  if (!limit["pass"].get<bool>())
    throw text::LimitNotMet(fmt::format("{}: not accepted, the machine is to be qualified again", words));
  fmt::print(out, "{}: accepted\n", words);
}

/// The model's own deviations over the working volume, for the report.
void add_field(nlohmann::ordered_json& json, const model::Machine& machine) {
  constexpr std::size_t kNodes = 7;  // along each axis
  std::string why_not;
  if (auto field = results::volume_json(machine, kNodes, why_not))
    json["field"] = std::move(*field);
  else
    json["field_note"] =
        fmt::format("The report has no diagram of the error over the working volume: {}", why_not);
}

/// Did it help?
void run_before_after(const CompareArguments& arguments) {
  if (arguments.before.empty() || arguments.after.empty())
    throw text::InputError("--before and --after must be given together");
  if (!arguments.measurements.empty())
    throw text::InputError(fmt::format("\"{}\": with --before and --after give no other measurement files",
                                       arguments.measurements.front()));
  if (arguments.datum)
    throw text::InputError(
        "--datum is for the files MEAS; with --before and --after the command always fits the set-up of both "
        "measurements");
  if (!arguments.limit.empty())
    throw text::InputError("--limit is for the files MEAS, not for --before and --after");
  if (!arguments.by.empty())
    throw text::InputError("--by is for the files MEAS, not for --before and --after");
  if (!arguments.residuals.empty())
    throw text::InputError("--residuals is for the files MEAS, not for --before and --after");
  const model::Machine machine = read_model(arguments.machine);
  const model::ImageCorrection images = simulate::corrections_of_images(arguments.images);
  const residual::BeforeAfter result =
      residual::compare_before_after(machine, model::read_measurement(arguments.before, machine, images),
                                     model::read_measurement(arguments.after, machine, images));
  if (!arguments.output.empty()) {
    std::vector<std::string> files = arguments.before;
    files.insert(files.end(), arguments.after.begin(), arguments.after.end());
    text::write_file(arguments.output, report::improvement_report_html(arguments.header.on(
                                           results::before_after_page(result, machine.name, files))));
  }
  write_json(arguments.json, results::before_after_json(result));
  for (const std::string& note : machine.notes) fmt::print(stderr, "note: {}\n", note);
  results::print_before_after(human_stream(arguments.json), result);
}

void run_compare(const CompareArguments& arguments) {
  if (!arguments.before.empty() || !arguments.after.empty()) return run_before_after(arguments);
  if (arguments.measurements.empty())
    throw text::InputError("compare needs measurement files: MEAS, or --before and --after");
  auto [text, as_given, m] = read_survey({arguments.machine, arguments.images, arguments.measurements, {}});
  repeat_findings(as_given);
  model::Machine machine = arguments.datum ? fit::set_up(as_given, m) : as_given;
  const Eigen::VectorXd residual = fit::residuals(machine, m);
  for (const fit::FileNoise& noise : fit::file_noise_of_residual(m, residual))
    machine.notes.push_back(noise.sentence());
  nlohmann::ordered_json json = results::compare_json(machine, m, residual);
  results::add_failure(json, residual::failure_picture(machine, m, residual));
  if (arguments.datum) json["datum"] = "fitted";
  if (!arguments.limit.empty())
    json["limit"] = results::judge_residuals(m, residual, results::residual_limit(arguments.limit));
  if (!arguments.by.empty()) json["groups"] = results::group_table(machine, m, residual, arguments.by);
  if (!arguments.output.empty()) {
    nlohmann::ordered_json with_detail = json;
    results::add_detail(with_detail, machine, m, residual);
    add_field(with_detail, machine);
    text::write_file(arguments.output,
                     report::compare_report_html(arguments.header.on(std::move(with_detail))));
  }
  if (!arguments.residuals.empty()) text::write_file(arguments.residuals, results::residual_csv(m, residual));
  write_json(arguments.json, json);
  for (const std::string& note : machine.notes) fmt::print(stderr, "note: {}\n", note);
  for (const fit::OtherSetUp& one : fit::files_set_up_elsewhere(machine, m))
    fmt::print(stderr, "note: {}; {}\n", one.sentence(),
               arguments.datum
                   ? "fit a survey that has rows of this set-up before you compare"
                   : "--datum fits the set-up to these rows; vernier check always fits the set-up");
  print_result(human_stream(arguments.json), json);
  results::print_domains(human_stream(arguments.json), json["domains"]);
  if (!arguments.by.empty()) print_groups(human_stream(arguments.json), json["groups"]);
  if (!arguments.limit.empty()) judge(human_stream(arguments.json), json["limit"]);
}

}  // namespace

void register_compare(CLI::App& vernier) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = vernier.add_subcommand(
      "compare", "Compare a model with measurements: size of the residual, and where the model fails");
  command->add_option("MACHINE", arguments->machine, "machine file (XML)")->type_name(kReads)->required();
  command->add_option("MEAS", arguments->measurements, "measurement files (CSV)")->type_name(kReads);
  // One value each time: what follows it may be the machine file.
  const auto several = [command](const char* option, std::vector<std::string>& list, const char* what) {
    return command->add_option(option, list, what)->expected(1)->allow_extra_args(false)->take_all();
  };
  several("--before", arguments->before,
          "measurement without the correction (CSV): with --after the command tests whether the correction "
          "reduced the error; may be repeated")
      ->type_name(kReads);
  several("--after", arguments->after,
          "measurement with the correction (CSV), compared with --before; may be repeated; do not give MEAS")
      ->type_name(kReads);
  several(
      "--by", arguments->by,
      "compare the residuals between the groups of this column (operator, coolant, tool …); may be repeated");
  command->add_option("--limit", arguments->limit,
                      "limit of the residuals, to accept or requalify a machine: 2u, 25um or 0.025deg, for "
                      "the check rows (without check rows: for the fit rows); rms=1.5u tests the rms; exit "
                      "status 2 if a residual exceeds the limit");
  command->add_flag("--datum", arguments->datum,
                    "fit the set-up of the instrument (free BaseShifts) before the comparison: the residuals "
                    "then contain no offset and rotation of the set-up");
  command->add_option("--images", arguments->images, simulate::kImagesHelp)->type_name(kReadsFolder);
  command
      ->add_option("-o,--output", arguments->output,
                   "file for the report (HTML, one file that opens without a network)")
      ->type_name(kWrites);
  add_report_header(*command, arguments->header);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->add_option("--residuals", arguments->residuals, kResidualsHelp)->type_name(kWrites);
  command->footer(
      "The report has the ISO 230-4 values and the polar plot (for ball-bar data), the residual against "
      "every recorded\n"
      "quantity, sentences about where the model fails, and the error field of the model over the volume. "
      "The command fits no\n"
      "parameter: a wrong offset, squareness or scale is therefore also a finding; run `fit` first to see "
      "only errors that no\n"
      "parameter explains. With --before and --after the report has the errors against the nominal machine "
      "in the best set-up\n"
      "of each measurement, and their reduction with its interval, in all and by reading and feed "
      "(tools/docs/compare.md).\n"
      "Exit status 0 done, 1 bad input, 2 a residual exceeds --limit.");
  command->callback([arguments] { run_compare(*arguments); });
}

}  // namespace vernier::commands::compare_cli
