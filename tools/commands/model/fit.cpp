// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>
#include <set>

#include "tools/commands/command.h"
#include "tools/commands/other_readings.h"
#include "tools/commands/out/square_fit.h"
#include "tools/commands/survey.h"
#include "tools/exchange/tip_link.h"
#include "tools/fit/coverage/domain.h"
#include "tools/fit/decisions.h"
#include "tools/fit/fit.h"
#include "tools/fit/freedom.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/fit/set_up.h"
#include "tools/fit/size.h"
#include "tools/format/units.h"
#include "tools/lint/dense_points.h"
#include "tools/lint/measurement_meaning.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"
#include "tools/results/residual_csv.h"
#include "tools/results/results.h"
#include "tools/simulate/corrected.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::commands::fit_cli {
namespace {

struct FitArguments {
  std::string machine, output, json, images, residuals;
  std::vector<std::string> measurements;
  std::vector<std::string> stages, priors, free, hold;
  std::string loss = "squared", solver = "normal-equations";
  double loss_scale = 3;
};

/// Combinations that the readings do not determine, largest reach first.
void print_decisions(std::FILE* out, const fit::FitResult& result) {
  const std::vector<fit::Decision> decisions = fit::decisions_of(result);
  if (decisions.empty()) return;
  fmt::print(out, "not determined by the data; set to the value nearest nominal (in units of each scale):\n");
  for (const fit::Decision& decision : decisions) fmt::print(out, "  {}\n", decision.sentence);
}

void print_stages(std::FILE* out, const fit::FitResult& result) {
  for (std::size_t i = 0; i < result.stages.size(); ++i) {
    const fit::StageFigures& stage = result.stages[i];
    fmt::print(out, "stage {}: {} parameters ({}), {} iterations: rms of fit rows {}, rms of check rows {}\n",
               i + 1, stage.parameters, stage.patterns, stage.iterations,
               results::number_or_dash(stage.fit.rms_um, "um"),
               results::number_or_dash(stage.check.rms_um, "um"));
  }
}

/// The combination with the least information in the data, if it is weak enough to matter.
void print_weakest(std::FILE* out, const fit::FitResult& result) {
  constexpr double kWeak = 1e-2;
  for (const fit::Observability::Weak& weak : result.observability.weakest) {
    if (weak.ratio > kWeak) continue;
    std::string names;
    for (std::size_t i = 0; i < weak.parts.size() && i < 6; ++i)
      names += (i ? ", " : "") + result.parameters[weak.parts[i]].name;
    fmt::print(out, "weakly determined ({:.1e} of the best): {}{}\n", weak.ratio, names,
               weak.parts.size() > 6 ? ", ..." : "");
  }
}

/// What rows met, and what the size of the machine rests on.
void print_things(std::FILE* out, const fit::FitResult& result) {
  constexpr std::size_t kMost = 12;  // lines
  for (std::size_t i = 0; i < result.things.size() && i < kMost; ++i) {
    const fit::ThingEstimate& one = result.things[i];
    fmt::print(out, "{} {}{}: {:.4f}, {:.4f}, {:.4f} mm +- {:.2g}, {:.2g}, {:.2g} mm", one.type, one.name,
               one.setup.empty() ? "" : " in set-up " + one.setup, one.place_mm.x(), one.place_mm.y(),
               one.place_mm.z(), one.u_place_mm.x(), one.u_place_mm.y(), one.u_place_mm.z());
    if (one.radius_mm) fmt::print(out, ", radius {:.5f} mm +- {:.2g} mm", *one.radius_mm, one.u_radius_mm);
    fmt::print(out, " ({} touches)\n", one.touches);
  }
  if (result.things.size() > kMost)
    fmt::print(out, "{} more points and artefacts are in the JSON result\n", result.things.size() - kMost);
  if (result.size && result.size->known) fmt::print(out, "{}\n", fit::size_sentence(*result.size));
}

/// What later commands will repeat.
void print_findings(std::FILE* out, const fit::FitResult& result) {
  if (result.normalised_check)
    fmt::print(out,
               "residuals of the check rows divided by the standard uncertainty of reading and model: rms "
               "{:.3f}, {:.1f} % within 3\n",
               result.normalised_check->rms, 100 * result.normalised_check->within_3);
  for (const model::FitRecord::Finding& one : result.machine.fitted->findings)
    fmt::print(out, "found: {} ({})\n", one.text, one.code);
}

/// Thermometers whose readings are not plausible in a workshop.
void print_odd_inputs(std::FILE* out, const model::Machine& machine) {
  for (const model::FitRecord::Range& range : machine.fitted->measured) {
    const auto input = machine.find_input(range.name);
    if (!input) continue;
    const auto unit = format::find_unit(machine.inputs[*input].unit);
    if (!unit || unit->dimension != format::Dimension::kTemperature) continue;
    const auto degC = [&](double value) { return value * unit->factor + unit->offset; };
    const std::string doubt = lint::temperature_doubt(degC(range.min), degC(range.max));
    if (!doubt.empty())
      fmt::print(out, "{} reads {:.4g} to {:.4g} {}: {}\n", range.name, range.min, range.max, unit->name,
                 doubt);
  }
}

void print_result(std::FILE* out, const fit::FitResult& result, const model::Measurement& m) {
  print_stages(out, result);
  fmt::print(out, "{:<24} {:>15} {:>12}  {:<6} {}\n", "parameter", "value", "std", "unit", "from");
  const std::vector<results::ChainTerm> chain = results::chain_expressions(result.machine);
  for (const fit::ParameterEstimate& item : result.estimates) {
    const std::string note = results::reversal_note(chain, item.name, item.value, item.unit);
    // A value far below its uncertainty is the arithmetic's zero.
    constexpr double kNothing = 1e-9;  // of the standard uncertainty
    const double value = std::abs(item.value) < kNothing * item.std ? 0 : item.value;
    fmt::print(out, "{:<24} {:>15.6g} {:>12.2g}  {:<6} {}{}\n", item.name, value, item.std, item.unit,
               item.from != fit::Origin::kPrior ? fit::origin_name(item.from)
               : item.moved()                   ? "hardly measured; as uncertain as nominal +- scale"
                                                : "not measured; stays at nominal +- scale",
               note.empty() ? "" : "; " + note);
  }
  print_decisions(out, result);
  print_things(out, result);
  print_odd_inputs(out, result.machine);
  for (const auto& [name, std] : result.priors)
    fmt::print(out, "prior: {} counts as measured at its nominal value, with standard uncertainty {:g}\n",
               name, std);
  print_weakest(out, result);
  const fit::RoleStatistics &before = result.before, &after = result.after, &check = result.check;
  using results::error_or_dash;
  if (result.only_set_up)
    fmt::print(out, "rms before      {}   with only the set-up fitted\n",
               error_or_dash(result.only_set_up->rms_um, result.only_set_up->rms_urad));
  else
    fmt::print(out, "rms before      {}\n", error_or_dash(before.rms_um, before.rms_urad));
  fmt::print(out, "rms fit rows    {}   max {}\n", error_or_dash(after.rms_um, after.rms_urad),
             error_or_dash(after.max_um, after.max_urad));
  fmt::print(out, "rms check rows  {}   max {}\n", error_or_dash(check.rms_um, check.rms_urad),
             error_or_dash(check.max_um, check.max_urad));
  if (after.rms_um && after.rms_urad)
    fmt::print(out, "rms rotations   {} before {}\n", results::number_or_dash(after.rms_urad, "urad"),
               results::number_or_dash(result.only_set_up.value_or(before).rms_urad, "urad"));
  fmt::print(out, "noise           {}\n", error_or_dash(result.noise_um, fit::noise_urad(m)));
  for (const fit::FileFactor& one : result.file_factors)
    if (one.factor > 1) fmt::print(out, "{}\n", one.sentence());
  if (!result.noise.independent())
    fmt::print(out,
               "correlated part of the residual, taken as correlated errors of the readings in every "
               "uncertainty: {}\n",
               fit::in_words(result.noise, fit::noise_unit(m)));
  fmt::print(out, "{} observations, {} parameters, rank {}, {} rows excluded, {} iterations{}\n",
             result.before.count, result.parameters.size(), result.observability.rank, m.excluded,
             result.iterations, result.converged ? "" : ", NOT CONVERGED");
  print_findings(out, result);
  constexpr double kWild = 20;  // as the rule `outlier` of tools/docs/safety.md, which looks at the fit rows
  if (result.worst_check.ratio > kWild)
    fmt::print(out,
               "the reading {} of the check rows differs by {:.3g} standard deviations: examine this reading "
               "before you trust the check rows\n",
               result.worst_check.reading, result.worst_check.ratio);
}

std::vector<std::string> split_all(const std::vector<std::string>& texts) {
  std::vector<std::string> all;
  for (const std::string& text : texts)
    for (std::string& one : text::parts_of(text, ',')) all.push_back(std::move(one));
  return all;
}

fit::Prior prior_of(const std::string& text) {
  const auto at = text.rfind('=');
  const auto std = at == std::string::npos ? std::nullopt : text::parse_number(text.substr(at + 1));
  if (!std || *std <= 0) throw text::InputError("\"" + text + "\": a prior is NAME=STD");
  return {text.substr(0, at), *std};
}

/// Held parameters with a value of an earlier fit that its readings did not determine: these values are no
/// measurement, and this fit takes them as exact. Empty: none.
std::string held_without_data(const model::Machine& machine, const fit::FitResult& result) {
  if (!machine.fitted) return {};
  const model::FitRecord& record = *machine.fitted;
  std::set<std::string> free, held;
  for (const fit::ParameterEstimate& one : result.estimates) free.insert(one.name);
  for (std::size_t i = 0; i < std::min(record.parameters.size(), record.origins.size()); ++i) {
    const std::string& name = record.parameters[i];
    if (free.contains(name) || name.starts_with("BaseShift") || name.starts_with("ToolShift")) continue;
    const bool moved = static_cast<Eigen::Index>(i) < record.values.size() &&
                       record.values[static_cast<Eigen::Index>(i)] != 0;
    if (moved && record.origins[i] != fit::origin_name(fit::Origin::kData))
      held.insert(model::without_station(name));
  }
  if (held.empty()) return {};
  return fmt::format(
      "the fit holds {} at values of an earlier fit that its readings did not determine: begin with the "
      "machine file from before that fit, where they are nominal",
      fmt::join(held, ", "));
}

/// True if the survey of a machine with touched objects has distances between points: a printed square.
bool has_square(const model::Machine& machine, const model::Measurement& m) {
  return !machine.artefacts.empty() && std::ranges::any_of(m.observations, [](const model::Observation& one) {
    return one.kind == format::ReadingKind::kDistance;
  });
}

/// The remedy if a free tool point explains most of the residual of a fit; otherwise empty.
std::string unknown_tool(const model::Machine& machine, const model::Measurement& m, fit::FitOptions options,
                         const fit::FitResult& held) {
  std::vector<std::string> names;
  for (const model::Static& one : machine.statics)
    if (one.hidden && (one.name == "TPX" || one.name == "TPY" || one.name == "TPZ"))
      names.push_back(one.name);
  if (names.empty()) return {};
  options.progress = {};
  const fit::FitResult with_tool = fit::fit(fit::with_freedom(machine, names, {}), m, options);
  if (!with_tool.absurd.empty() || !with_tool.after.rms_um || !held.after.rms_um) return {};
  constexpr double kFarBetter = 0.2;  // of the residual with the given tool point
  if (*with_tool.after.rms_um > kFarBetter * *held.after.rms_um) return {};
  return fmt::format(
      "The tool point of the machine file is probably not that of the measurement: with a free tool point "
      "the "
      "residual is {:.3g} um. State the tool (vernier new --tool), or fit it: --free {}",
      *with_tool.after.rms_um, fmt::join(names, ","));
}

void run_fit(const FitArguments& arguments) {
  Survey survey = read_survey(
      {arguments.machine, arguments.images, arguments.measurements, {}}, [&](const model::Machine& read) {
        return fit::with_freedom(read, split_all(arguments.free), split_all(arguments.hold));
      });
  estimate_noise(survey);
  const auto& [text, machine, m] = survey;
  fit::FitOptions options;
  options.loss = arguments.loss == "huber"    ? fit::Loss::kHuber
                 : arguments.loss == "cauchy" ? fit::Loss::kCauchy
                                              : fit::Loss::kSquared;
  options.loss_scale = arguments.loss_scale;
  options.solver = arguments.solver == "ceres" ? fit::Solver::kCeres : fit::Solver::kNormalEquations;
  for (const std::string& stage : arguments.stages) options.stages.push_back(text::parts_of(stage, ','));
  for (const std::string& prior : arguments.priors) options.priors.push_back(prior_of(prior));
  Progress progress("fit");
  options.progress = [&](int iteration, double cost) {
    progress.update(iteration / 100.0,
                    fmt::format("iteration {}, weighted sum of squares {:.6g}", iteration, cost));
  };
  const fit::FitResult result = fit::fit(machine, m, options);
  const bool missing = result.machine.fitted &&
                       std::ranges::any_of(result.machine.fitted->findings,
                                           [](const auto& one) { return one.code == "something-missing"; });
  const std::string tool =
      missing || !result.absurd.empty() ? unknown_tool(machine, m, options, result) : std::string();
  const std::string rows =
      missing || !result.absurd.empty() ? readings_of_other_rows(machine, m) : std::string();
  if (!result.absurd.empty() && !rows.empty()) throw text::LimitNotMet(rows + "; nothing is written");
  if (!result.absurd.empty())
    throw text::LimitNotMet(result.absurd + "; nothing is written" + (tool.empty() ? "" : ". ") + tool);
  nlohmann::ordered_json json = results::fit_json(result, m);
  for (const std::string& note : {tool, rows, other_zero_of_joint(machine, m, result),
                                  readings_of_one_weight(m), held_without_data(machine, result)}) {
    if (note.empty()) continue;
    json["notes"].push_back(note);
    fmt::print(stderr, "note: {}\n", note);
  }
  for (const lint::DensePoints& points : lint::dense_points(result.machine, m)) {
    if (points.one_column) continue;  // what to do is not certain before a diagnosis
    json["notes"].push_back(lint::dense_points_text(points) + ": " + lint::dense_points_remedy(points));
    fmt::print(stderr, "note: {}\n", json["notes"].back().get<std::string>());
  }
  if (has_square(machine, m) && square_is_open(result.machine)) {
    const FitOfSquare again = fit_of_square(result.machine);
    if (!again.hold.empty()) {
      json["fit_again"] = {{"hold", again.hold}, {"free", again.free}};
      json["notes"].push_back(remedy_of_unmeasured(again));
      fmt::print(stderr, "note: {}\n", remedy_of_unmeasured(again));
    }
  }
  const std::vector<std::string> places = exchange::tool_shift_places(result.machine, text);
  for (const std::string& one : places) json["notes"].push_back(one);
  if (!arguments.output.empty())
    text::write_file(
        arguments.output,
        fit::close_domains(model::update_machine_text(text, result.machine, true), result.machine, m));
  if (!arguments.residuals.empty())
    text::write_file(arguments.residuals, results::residual_csv(m, result.residual));
  write_json(arguments.json, json);
  for (const std::string& note : machine.notes) fmt::print(stderr, "note: {}\n", note);
  for (const fit::OtherSetUp& one : fit::files_set_up_elsewhere(result.machine, m))
    fmt::print(
        stderr, "note: {}{}\n", one.sentence(),
        one.rows.empty() ? "; to fit this set-up, give at least three rows of the file the role fit" : "");
  print_result(human_stream(arguments.json), result, m);
  for (const std::string& one : places) fmt::print(human_stream(arguments.json), "{}\n", one);
  results::print_domains(human_stream(arguments.json), json["domains"]);
}

}  // namespace

void register_fit(CLI::App& vernier) {
  auto arguments = std::make_shared<FitArguments>();
  CLI::App* command =
      vernier.add_subcommand("fit", "Estimate the free parameters of a machine from measurements");
  command->add_option("MACHINE", arguments->machine, "machine file (XML)")->type_name(kReads)->required();
  command->add_option("MEAS", arguments->measurements, "measurement files (CSV)")
      ->type_name(kReads)
      ->required();
  command->add_option("-o,--output", arguments->output, "the fitted machine file")->type_name(kWrites);
  command->add_option("--images", arguments->images, simulate::kImagesHelp)->type_name(kReadsFolder);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->add_option("--residuals", arguments->residuals, kResidualsHelp)->type_name(kWrites);
  command->add_option("--loss", arguments->loss, "squared, huber or cauchy")
      ->check(CLI::IsMember({"squared", "huber", "cauchy"}))
      ->capture_default_str();
  command
      ->add_option("--loss-scale", arguments->loss_scale,
                   "residual at which a robust loss becomes linear, in u (without u: in robust standard "
                   "deviations of the residual)")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--stage", arguments->stages,
                      "stage of the fit before the fit of all parameters: patterns of the parameters that "
                      "this stage fits, separated by commas; may be repeated for further stages");
  command->add_option(
      "--free", arguments->free,
      "patterns of free parameters in addition to those of the file: statics, table.X.rY, BaseShift, "
      "scalefactor.X, ToolShift (if the machine file has one); the tool point of a robot: TPX,TPY,TPZ; may "
      "be repeated");
  command->add_option(
      "--hold", arguments->hold,
      "patterns of parameters that the fit does not change (applied after --free); may be repeated");
  command->add_option("--prior", arguments->priors,
                      "NAME=STD: prior for parameters: their nominal value counts as a reading with the "
                      "standard uncertainty STD; may be repeated");
  command->add_option("--solver", arguments->solver, "solver: normal-equations, or ceres as a cross-check")
      ->check(CLI::IsMember({"normal-equations", "ceres"}))
      ->capture_default_str();
  command->footer(
      "Weighted least squares (1/u^2) on rows with role fit. The fit sets parameters that the readings do "
      "not determine\n"
      "to the values nearest nominal, in units of each parameter's scale, and lists them "
      "(tools/docs/fit.md). Exit status 0 done,\n"
      "1 bad input, 2 the fit did not converge or the readings are not of this machine: nothing written.");
  command->callback([arguments] { run_fit(*arguments); });
}

}  // namespace vernier::commands::fit_cli
