// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/report_header.h"
#include "tools/commands/survey.h"
#include "tools/diagnose/causes.h"
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/sentences.h"
#include "tools/effects/roles.h"
#include "tools/fit/fit.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/model/machine_reader.h"
#include "tools/plan/advice.h"
#include "tools/report/report.h"
#include "tools/results/diagnosis_json.h"
#include "tools/results/residual_csv.h"
#include "tools/results/results.h"
#include "tools/simulate/corrected.h"
#include "tools/text/files.h"

namespace vernier::commands::diagnose_cli {
namespace {

struct DiagnoseArguments {
  SurveyArguments survey;
  std::string output, json, write, residuals;
  std::vector<std::string> effects;
  std::size_t most = 5;
  ReportHeader header;
};

void print_ladder(std::FILE* out, const diagnose::Diagnosis& d, const model::Measurement& m) {
  fmt::print(out, "{:<58} {:>12} {:>12}\n", "stepwise model", "fit rows", "check rows");
  const diagnose::LadderStep* before = nullptr;
  for (const diagnose::LadderStep& step : d.ladder) {
    const bool lengths = step.rms_um.has_value();
    const std::optional<double>& check = lengths ? step.check_rms_um : step.check_rms_urad;
    const bool rises =
        before != nullptr && check && *check > (lengths ? before->check_rms_um : before->check_rms_urad);
    fmt::print(
        out, "  {:<56} {:>12} {:>12}{}\n", step.effect.empty() ? "the model as given" : "+ " + step.said,
        results::error_or_dash(step.rms_um, step.rms_urad),
        results::error_or_dash(step.check_rms_um, step.check_rms_urad),
        !rises                            ? ""
        : !step.confirmed.value_or(false) ? "  the check rows (held-out rows) do not confirm this step"
        : step.of_check_rows              ? "  more in um; weighted by 1/u^2 the check rows confirm the step"
                             : "  too small for the check rows; runs held out in turn confirm the step");
    before = &step;
  }
  fmt::print(out, "  {:<56} {:>12}\n", "noise", results::error_or_dash(d.base.noise_um, fit::noise_urad(m)));
}

void print_candidates(std::FILE* out, const diagnose::Diagnosis& d) {
  if (d.candidates.empty()) return;
  fmt::print(out, "{:<58} {:>8} {:>12} {:>12} {:>9}\n",
             "candidate effects, each evaluated as the only added effect", "score", "fit rows", "check rows",
             "p");
  for (const diagnose::CandidateFinding& c : d.candidates) {
    fmt::print(out, "{} {:<56} {:>8.1f} {:>12} {:>12} {:>9.2g}\n", c.accepted ? "*" : " ", c.candidate.spoken,
               c.score, results::error_or_dash(c.rms_after_um, c.rms_after_urad),
               results::error_or_dash(c.check_rms_after_um, c.check_rms_after_urad), c.p_value);
    if (!c.why_not.empty()) fmt::print(out, "    not accepted: {}\n", c.why_not);
    if (!c.confounded_with.empty())
      fmt::print(out, "    not distinguishable in these data: {}\n", fmt::join(c.confounded_with, ", "));
    if (!c.accepted) continue;
    fmt::print(out, "    {}; in the chain: {}\n", diagnose::said_of(c), c.candidate.label);
    for (const fit::ParameterEstimate& p : c.parameters) {
      const std::string note = results::reversal_note(c.candidate, p);
      fmt::print(out, "    {} = {:.6g} +- {} {}{}\n", p.name, p.value, fmt::format("{:.2g}", p.std), p.unit,
                 note.empty() ? "" : " (" + note + ")");
    }
    fmt::print(out, "    vernier add '{}' MACHINE -o NEW\n", c.add);
  }
}

/// The set of causes, if it has more than one: a single one is the explanation. Of one cyclic error with many
/// possible periods three are printed; the explanation and the JSON result list them.
void print_causes(std::FILE* out, const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.causes.size() < 2) return;
  fmt::print(out, "causes that the data do not reject (significance level {:g}):\n",
             diagnose::kLevelOfCauses);
  constexpr std::size_t kPeriods = 3;
  std::map<std::string, std::size_t> periods;
  for (const diagnose::Cause& cause : diagnosis.causes)
    if (!cause.period || !cause.candidate || ++periods[cause.candidate->spoken] <= kPeriods)
      fmt::print(out, "  {:<60} evidence {:.1f}\n", cause.description, cause.evidence);
  for (const auto& [spoken, count] : periods)
    if (count > kPeriods) fmt::print(out, "  {}: {} further periods\n", spoken, count - kPeriods);
  fmt::print(out, "\n");
}

/// The candidate with the most evidence that failed no test and is not in the stepwise model; nullptr: none
/// has evidence, or the stepwise model has an effect with more.
const diagnose::CandidateFinding* best_open(const diagnose::Diagnosis& d) {
  const diagnose::CandidateFinding* best = nullptr;
  double least = 0;  // score
  for (const diagnose::CandidateFinding& one : d.candidates) {
    if (one.accepted) least = std::max(least, one.score);
    const bool open = !one.accepted && one.why_not.empty() && !one.add.empty();
    if (open && one.score > 0 && (best == nullptr || one.score > best->score)) best = &one;
  }
  return best != nullptr && best->score > least ? best : nullptr;
}

/// What to do with effects that reduce the residual, if the verdict names no cause for all of it.
void print_next_step(std::FILE* out, const diagnose::Diagnosis& d) {
  if (d.verdict != diagnose::Verdict::kUnexplained || d.candidates.empty()) return;
  if (const diagnose::CandidateFinding* const best = best_open(d))
    fmt::print(
        out,
        "next: to try the candidate \"{}\", vernier add '{}' MACHINE -o NEW, then vernier fit NEW MEAS -o "
        "FITTED; keep it only if the residuals of the check rows divided by their standard uncertainty "
        "decrease (vernier fit prints their rms)\n",
        best->candidate.spoken, best->add);
  else if (d.ladder.size() > 1)
    fmt::print(
        out,
        "next: the option --machine-out NEW writes the machine file with the {} of the stepwise model, "
        "fitted; the rest of the residual has no name in the catalogue\n",
        d.ladder.size() == 2 ? "effect" : fmt::format("{} effects", d.ladder.size() - 1));
  else
    fmt::print(
        out,
        "next: no candidate has evidence (a score above 0, and no failed test): measure again, or find "
        "the cause outside the catalogue; adding a candidate is no explanation\n");
}

/// Residuals of the machine of the last step.
void write_residuals(const DiagnoseArguments& arguments, const diagnose::Diagnosis& diagnosis) {
  const model::Machine machine = model::parse_machine(diagnosis.machine_text, arguments.survey.machine);
  const model::Measurement m = model::read_measurement(
      arguments.survey.measurements, machine, simulate::corrections_of_images(arguments.survey.images));
  text::write_file(arguments.residuals, results::residual_csv(m, fit::residuals(machine, m)));
}

void run_diagnose(const DiagnoseArguments& arguments) {
  Survey survey = read_survey(arguments.survey);
  std::vector<fit::FileNoise> noise = estimate_noise(survey);
  auto& [text, machine, m] = survey;
  const std::vector<std::string> column_sentences = effects::complete_columns(machine, m);
  diagnose::DiagnoseOptions options;
  options.effects = effects::effect_catalogue(arguments.effects);
  options.most_effects = arguments.most;
  Progress progress("diagnose");
  options.progress = [&](double fraction, const std::string& step) { progress.update(fraction, step); };
  diagnose::Diagnosis diagnosis = diagnose_and_estimate_noise(text, machine, m, noise, options);
  const StationAdvice stations = station_advice(diagnosis, machine, m);
  add_sentences(diagnosis.explanation, noise_sentences(noise));
  add_sentences(diagnosis.explanation, stations.sentences);
  add_sentences(diagnosis.explanation, column_sentences);
  diagnosis.next_measurement = plan::advice_for(text, machine, m, diagnosis, options.effects);
  const nlohmann::ordered_json json = results::diagnosis_json(diagnosis, m);
  if (!arguments.output.empty()) {
    nlohmann::ordered_json page = json;
    page["machine"] = machine.name;
    page["files"] = arguments.survey.measurements;
    text::write_file(arguments.output, report::diagnose_report_html(arguments.header.on(std::move(page))));
  }
  if (!arguments.write.empty()) text::write_file(arguments.write, diagnosis.machine_text);
  if (!arguments.residuals.empty()) write_residuals(arguments, diagnosis);
  write_json(arguments.json, json);
  std::FILE* out = human_stream(arguments.json);
  fmt::print(out, "verdict: {}\n{}\n\n", diagnose::verdict_name(diagnosis.verdict), diagnosis.explanation);
  print_causes(out, diagnosis);
  print_ladder(out, diagnosis, m);
  fmt::print(out, "\n");
  print_candidates(out, diagnosis);
  if (!stations.has_call) print_next_step(out, diagnosis);  // otherwise the explanation has the next step
  for (const std::string& next : diagnosis.next_measurement) fmt::print(out, "measure next: {}\n", next);
}

}  // namespace

void register_diagnose(CLI::App& vernier) {
  auto arguments = std::make_shared<DiagnoseArguments>();
  CLI::App* command =
      vernier.add_subcommand("diagnose", "Find which physical effect is missing from a model");
  add_survey(*command, arguments->survey);
  command->add_option("-o,--output", arguments->output, "report (HTML)")->type_name(kWrites);
  add_report_header(*command, arguments->header);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->add_option("--residuals", arguments->residuals, kResidualsHelp)->type_name(kWrites);
  command
      ->add_option("--machine-out", arguments->write,
                   "the machine file with the effects of the stepwise model, fitted")
      ->type_name(kWrites);
  command->add_option("--effects", arguments->effects, "files with effects of your own; may be repeated")
      ->type_name(kReads);
  command->add_option("--most", arguments->most, "largest number of effects in the stepwise model")
      ->check(CLI::Range(1, 10))
      ->capture_default_str();
  command->footer(
      "The command first fits the model, and then searches for effects that explain the residual better than "
      "the free\n"
      "parameters of the model can. The verdict is missing-effect, ambiguous, unexplained, instrument or "
      "consistent.\n"
      "Check rows only test the result. Exit status 0 for every verdict, 1 bad input.");
  command->callback([arguments] { run_diagnose(*arguments); });
}

}  // namespace vernier::commands::diagnose_cli
