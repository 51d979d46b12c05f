// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/commands/judge/part_kinds.h"
#include "tools/commands/report_header.h"
#include "tools/fit/fit.h"
#include "tools/kinematics/at.h"
#include "tools/model/fit_record.h"
#include "tools/model/measurement.h"
#include "tools/report/report.h"
#include "tools/results/fit_findings.h"
#include "tools/simulate/corrected.h"
#include "tools/text/error.h"
#include "tools/text/optional_json.h"
#include "tools/text/words.h"
#include "tools/tolerance/conformity.h"

namespace vernier::commands::part_cli {
namespace {

using Json = nlohmann::ordered_json;

struct ConformityArguments {
  std::string machine, tool, frame = "part", images, output, json;
  PartSource part;
  ReportHeader header;
  std::vector<std::string> measurements, effects;
  double process_um = 0;
  std::uint64_t seed = 1;
  bool with_rotary = false, uncorrected = false;
};

constexpr double kUm = 1000;  // per mm

Json expectation_json(const tolerance::Expectation& e) {
  return {{"value_um", kUm * e.value},
          {"mean_um", kUm * e.mean},
          {"std_um", kUm * e.std},
          {"interval_um", {kUm * e.low, kUm * e.high}},
          {"u95_um", kUm * e.u95},
          {"probability", text::or_null(e.probability)},
          {"verdict", e.verdict ? Json(tolerance::verdict_words(*e.verdict)) : Json(nullptr)}};
}

Json characteristic_json(const tolerance::CharacteristicResult& one, const tolerance::PlacedPart& part) {
  const tolerance::PartFeature& feature = part.features[one.feature].feature;
  Json json = {{"feature", feature.name},
               {"kind", tolerance::kind_name(feature.kind)},
               {"line", feature.line},
               {"characteristic", tolerance::characteristic_name(one.what)},
               {"limits_um", nullptr},
               {"uncorrected", expectation_json(one.off)},
               {"corrected", expectation_json(one.on)},
               {"dominant", one.dominant},
               {"never_measured", one.open},
               {"process", one.process},
               {"discrepancy", one.discrepancy},
               {"outside_measured", one.outside},
               {"sources", Json::array()}};
  if (one.limits_mm) json["limits_um"] = {kUm * (*one.limits_mm)[0], kUm * (*one.limits_mm)[1]};
  for (const tolerance::SourceShare& source : one.sources)
    json["sources"].push_back({{"name", source.name},
                               {"effect", source.effect},
                               {"fall_um", kUm * source.fall_mm},
                               {"largest", source.largest},
                               {"share_of_variance", source.variance},
                               {"never_measured", source.open}});
  return json;
}

/// Tests whether the part conforms: every characteristic with a tolerance, and the findings of the fit.
text::Assurance assurance_of(const model::Machine& machine, const tolerance::PartConformity& result,
                             const ConformityArguments& arguments) {
  text::Assurance word(text::AssuranceKind::kConformity);
  std::size_t asked = 0, open = 0;
  for (const tolerance::CharacteristicResult& one : result.characteristics) {
    const auto& verdict = arguments.uncorrected ? one.off.verdict : one.on.verdict;
    if (!verdict) continue;
    ++asked;
    open += *verdict == tolerance::PartVerdict::kConforms ? 0 : 1;
  }
  word.at_least("tolerances", static_cast<double>(asked), 1, "Characteristics with a tolerance.");
  word.at_most("not-conforming", static_cast<double>(open), 0,
               "Number of characteristics that have a probability of conformity below 95 %, or that are "
               "outside the measured range.");
  results::add_findings(word, machine);
  word.require("settled", result.settled,
               "The number of trials is sufficient: the limits of the intervals have converged.");
  for (const std::string& range : result.outside)
    word.not_covered(fmt::format("The part is outside the measured range: {}.", range));
  for (const std::string& name : result.stale)
    word.not_covered(fmt::format("A parameter was set by hand since the fit: {}.", name));
  if (arguments.process_um <= 0)
    word.not_covered(
        "The result does not include repeatability, tool and cutting, because --process was not given.");
  if (!result.open_known)
    word.not_covered(
        "The result does not include errors that the readings did not determine, because this machine file "
        "does not list such errors.");
  return word;
}

Json conformity_json(const model::Machine& machine, const ConformityArguments& arguments,
                     const tolerance::PlacedPart& part, const tolerance::PartConformity& result) {
  Json json = {
      {"machine", machine.name},
      {"part", arguments.part.path},
      {"motion", part.program ? "program" : "at-rest"},
      {"trials", result.trials},
      {"seed", result.seed},
      {"settled", result.settled},
      {"trials_through", result.exact ? "chain" : "linear"},
      {"linear_error_um", kUm * result.linear_mm},
      {"never_measured_known", result.open_known},
      {"stale", result.stale},
      {"outside_measured", result.outside},
      {"disturbance", machine.fitted->disturbance},
      {"discrepancy_um",
       {kUm * result.discrepancy_mm[0], kUm * result.discrepancy_mm[1], kUm * result.discrepancy_mm[2]}},
      {"findings", results::findings_json(machine)},
      {"assurance", assurance_of(machine, result, arguments).json()},
      {"characteristics", Json::array()}};
  for (const tolerance::CharacteristicResult& one : result.characteristics)
    json["characteristics"].push_back(characteristic_json(one, part));
  return json;
}

std::string words_of(const tolerance::Expectation& e) {
  // Two digits, and no minus before a zero.
  const auto um = [](double mm) { return std::round(100 * kUm * mm) / 100 + 0.0; };
  std::string text = fmt::format("{:.2f} um (95 %: {:.2f} to {:.2f})", um(e.value), um(e.low), um(e.high));
  if (e.probability)
    text += fmt::format(", {:.1f} % {}", 100 * *e.probability, tolerance::verdict_words(*e.verdict));
  return text;
}

/// Advice: correct a source that is reported, measure where no reading is.
std::string why(const tolerance::CharacteristicResult& one) {
  if (one.dominant.empty()) return "";
  if (one.dominant.size() == 1) return one.dominant[0];
  constexpr std::size_t kMost = 3;
  std::vector<std::string> names(
      one.dominant.begin(),
      one.dominant.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, one.dominant.size())));
  return "not distinguished: " + text::joined(names, ", ") +
         (one.dominant.size() > kMost ? fmt::format(" and {} more", one.dominant.size() - kMost) : "");
}

/// The source that the uncertainty comes from most.
std::string least_known(const tolerance::CharacteristicResult& one) {
  const auto most = std::max_element(one.sources.begin(), one.sources.end(),
                                     [](const auto& a, const auto& b) { return a.variance < b.variance; });
  if (one.discrepancy > one.process && (most == one.sources.end() || one.discrepancy > most->variance))
    return fmt::format("model discrepancy ({:.0f} %)", 100 * one.discrepancy);
  if (most == one.sources.end() || most->variance <= 0) return one.process > 0 ? "process" : "";
  if (one.process > most->variance) return fmt::format("process ({:.0f} %)", 100 * one.process);
  return fmt::format("{} ({:.0f} %)", most->name, 100 * most->variance);
}

/// What the machine does at a point: the same bore may differ as a feature and as a program by this alone.
std::string motion_words(const tolerance::PlacedPart& part) {
  return part.program ? "The motion is that of the part program, with its speeds, directions and reversals."
                      : "The machine is at rest at each point, and approaches the point from the previous "
                        "point. Effects of speed and reversal along a part program are not included.";
}

void print_conformity(std::FILE* out, const tolerance::PlacedPart& part,
                      const tolerance::PartConformity& result) {
  fmt::print(out, "{} trials, seed {}, {}\n", result.trials, result.seed,
             result.exact ? "each through the whole chain"
                          : "the model is linear in the uncertain parameters of the machine");
  fmt::print(out, "{}\n", motion_words(part));
  if (!result.settled) fmt::print(out, "the trials stopped before the ends of the intervals converged\n");
  for (const std::string& name : result.stale)
    fmt::print(out, "parameter that was set by hand since the fit: {}\n", name);
  for (const std::string& range : result.outside)
    fmt::print(out, "the part is outside the measured range: {}. Characteristics there have no verdict\n",
               range);
  if (const double most = *std::max_element(result.discrepancy_mm.begin(), result.discrepancy_mm.end());
      most > 0)
    fmt::print(out,
               "the model discrepancy is in every interval: {:.2g}, {:.2g}, {:.2g} um (standard deviation in "
               "x, y, z)\n",
               kUm * result.discrepancy_mm[0], kUm * result.discrepancy_mm[1],
               kUm * result.discrepancy_mm[2]);
  for (const tolerance::CharacteristicResult& one : result.characteristics) {
    const tolerance::PartFeature& feature = part.features[one.feature].feature;
    fmt::print(out, "\n{}: {}", feature.name, tolerance::characteristic_name(one.what));
    if (one.limits_mm && one.what == tolerance::PartCharacteristic::kSize)
      fmt::print(out, ", allowed {:+.4g} to {:+.4g} um", kUm * (*one.limits_mm)[0],
                 kUm * (*one.limits_mm)[1]);
    else if (one.limits_mm)
      fmt::print(out, ", zone of {:.4g} um", kUm * (*one.limits_mm)[1]);
    fmt::print(out, "\n  without correction {}\n  with correction    {}\n", words_of(one.off),
               words_of(one.on));
    if (!one.dominant.empty()) fmt::print(out, "  dominant: {}\n", why(one));
    if (const std::string source = least_known(one); !source.empty())
      fmt::print(out, "  least known: {}\n", source);
    if (result.open_known && one.open > 0.005)
      fmt::print(out, "  never measured: {:.0f} % of the variance\n", 100 * one.open);
  }
}

std::string conformity_page(const model::Machine& machine, const ConformityArguments& arguments,
                            const tolerance::PlacedPart& part, const tolerance::PartConformity& result) {
  Json table = {{"caption", "95 % intervals over the uncertainty of the fit; um"},
                {"columns",
                 {"feature", "characteristic", "allowed", "without correction", "with correction", "dominant",
                  "least known", "never measured"}},
                {"rows", Json::array()}};
  for (const tolerance::CharacteristicResult& one : result.characteristics)
    table["rows"].push_back(
        {part.features[one.feature].feature.name, tolerance::characteristic_name(one.what),
         one.limits_mm ? fmt::format("{:.4g} to {:.4g}", kUm * (*one.limits_mm)[0], kUm * (*one.limits_mm)[1])
                       : "-",
         words_of(one.off), words_of(one.on), why(one), least_known(one),
         fmt::format("{:.0f} %", 100 * one.open)});
  Json notes = Json::array();
  for (const std::string& range : result.outside)
    notes.push_back(
        fmt::format("The part is outside the measured range: {}. Characteristics outside the measured range "
                    "have no verdict.",
                    range));
  if (machine.fitted)
    for (const model::FitRecord::Finding& one : machine.fitted->findings)
      notes.push_back("Found by the fit: " + one.text);
  return report::improvement_report_html(arguments.header.on(
      {{"title", "Will the part be in tolerance?"},
       {"machine", machine.name},
       {"files", {arguments.machine, arguments.part.path}},
       {"sections",
        {{{"title", "Features"},
          {"prose",
           {fmt::format("{} trials (seed {}) over the covariance of the last fit, GUM supplement 1. {}",
                        result.trials, result.seed, motion_words(part))}},
          {"tables", {table}},
          {"notes", notes}}}}}));
}

model::Machine machine_of(const ConformityArguments& arguments) {
  model::Machine machine = read_model(arguments.machine);
  if (!arguments.measurements.empty()) {
    const model::Measurement rows = model::read_measurement(
        arguments.measurements, machine, simulate::corrections_of_images(arguments.images));
    fit::FitResult fitted = fit::fit(machine, rows);
    if (!fitted.absurd.empty()) throw text::LimitNotMet(fitted.absurd);
    if (!fitted.converged) throw text::LimitNotMet("the fit did not converge");
    machine = std::move(fitted.machine);
    repeat_findings(machine);
  }
  if (!machine.fitted)
    throw text::InputError(
        {machine.file, 0}, machine.name,
        "was never fitted (no <fitted>): give measurements, or a machine file that `vernier fit` wrote");
  if (!machine.fitted->converged) throw text::LimitNotMet("the fit of this machine file did not converge");
  return arguments.tool.empty() ? machine : kinematics::tooled(machine, arguments.tool);
}

/// The worst of the verdicts that the user asked about.
void judge(const tolerance::PlacedPart& part, const tolerance::PartConformity& result, bool uncorrected) {
  std::vector<std::string> failing;
  for (const tolerance::CharacteristicResult& one : result.characteristics) {
    const auto& verdict = uncorrected ? one.off.verdict : one.on.verdict;
    if (verdict && *verdict == tolerance::PartVerdict::kDoesNotConform)
      failing.push_back(fmt::format("{} of {}", tolerance::characteristic_name(one.what),
                                    part.features[one.feature].feature.name));
  }
  if (!failing.empty())
    throw text::LimitNotMet(fmt::format("out of tolerance{}: {}",
                                        uncorrected ? "" : " with the correction too",
                                        text::joined(failing, ", ")));
}

void run_conformity(const ConformityArguments& arguments) {
  const model::Machine machine = machine_of(arguments);
  const tolerance::PlacedPart part = placed_part(arguments.part, machine);
  Progress progress("trials");
  tolerance::ConformityOptions options;
  options.frame = arguments.frame == "machine" ? tolerance::PartFrame::kMachine : tolerance::PartFrame::kPart;
  options.seed = arguments.seed;
  options.process_mm = arguments.process_um / kUm;
  options.with_rotary = arguments.with_rotary || machine.correct_orientation;
  options.progress = [&](double share) { progress.update(share); };
  const tolerance::PartConformity result = tolerance::part_conformity(
      machine, part, arguments.part.path, effects::effect_catalogue(arguments.effects), options);
  if (!arguments.output.empty())
    text::write_file(arguments.output, conformity_page(machine, arguments, part, result));
  write_json(arguments.json, conformity_json(machine, arguments, part, result));
  std::FILE* out = human_stream(arguments.json);
  print_conformity(out, part, result);
  judge(part, result, arguments.uncorrected);
}

}  // namespace

void add_conformity(CLI::App& part) {
  auto a = std::make_shared<ConformityArguments>();
  CLI::App* command = part.add_subcommand(
      "conformity", "Will a part be in tolerance, with which probability, and which errors contribute most?");
  command->add_option("MACHINE", a->machine, "machine file (XML), fitted")->type_name(kReads)->required();
  command->add_option("PART", a->part.path, "features with tolerances (CSV), or a part program (RS-274)")
      ->type_name(kReads)
      ->required();
  command
      ->add_option("MEAS", a->measurements,
                   "measurement files (CSV) for a fit of the machine before the prediction; without them the "
                   "machine file is used as it is")
      ->type_name(kReads);
  command->add_option(
      "--place", a->part.place,
      "zero of the list in workpiece coordinates: \"X,Y,Z\", \"X,Y,Z,TURN\" or \"X,Y,Z,rX,rY,rZ\" (mm, deg)");
  command->add_option("--zero", a->part.zero,
                      "machine position of the program's zero, tool length included: \"X=120,Y=80,Z=-40\"");
  command->add_option("--at", a->part.at,
                      "inputs, and positions of axes that the part does not need: \"T=25\"");
  command->add_option("--tool", a->tool,
                      "a tool of the file's <tools>, or \"X,Y,Z\" in mm from the end of the chain");
  command
      ->add_option("--frame", a->frame,
                   "part: positions are relative to the datum features, or to all features if there is no "
                   "datum; machine: positions are machine coordinates")
      ->check(CLI::IsMember({"part", "machine"}))
      ->capture_default_str();
  command
      ->add_option("--position", a->part.position_mm,
                   "width of the position zone of a program's features, mm")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--size", a->part.size_mm,
                   "tolerance of the diameter of a program's circles, plus and minus, mm")
      ->check(CLI::PositiveNumber);
  command->add_option("--form", a->part.form_mm, "width of the form zone of a program's circles, mm")
      ->check(CLI::PositiveNumber);
  command
      ->add_option(
          "--process", a->process_um,
          "standard deviation of the independent error of each point, um: repeatability, tool, cutting")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--seed", a->seed, "of the trials")->capture_default_str();
  command
      ->add_option("--effects", a->effects, "files with effects of your own, for the names; may be repeated")
      ->type_name(kReads);
  command->add_flag("--rotary", a->with_rotary, "correct with all axes; default: as in the machine file");
  command->add_flag(
      "--uncorrected", a->uncorrected,
      "predict the part for the machine without its correction; the exit status is for this case");
  command->add_option("--images", a->images, simulate::kImagesHelp)->type_name(kReadsFolder);
  command->add_option("-o,--output", a->output, "file for the report (HTML)")->type_name(kWrites);
  add_report_header(*command, a->header);
  command->add_option("--json", a->json, "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "Monte Carlo simulation over the covariance of the last fit (JCGM 101). The verdict is \"conforms\" or "
      "\"does not\n"
      "conform\" if its probability is at least 95 % (ISO 14253-1:2017), else \"cannot be said\". Columns of "
      "a list: feature, kind\n"
      "(point plane cylinder), x y z, nx ny nz, i j k, diameter, length, width, position, size or size_low\n"
      "and size_high, form, datum (yes). Exit status 0 done (also for the verdict \"cannot be said\"), 1 "
      "bad\n"
      "input (nothing written), 2 a feature does not conform (all files are written) or is out of reach "
      "(nothing is written). See\n"
      "tools/docs/conformity.md.");
  command->callback([a] { run_conformity(*a); });
}

}  // namespace vernier::commands::part_cli
