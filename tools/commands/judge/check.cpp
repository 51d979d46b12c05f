// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "tools/check/history.h"
#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/maths/factors.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_writer.h"
#include "tools/model/parameters.h"
#include "tools/simulate/corrected.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::commands::check_cli {
namespace {

using Json = nlohmann::ordered_json;

struct CheckArguments {
  std::string machine, history, output, label, json, images;
  std::vector<std::string> measurements;
  double false_alarms = 0.01;
};

Json change_json(const check::Change& one) {
  return {{"name", one.quantity.name}, {"change", one.change}, {"std", one.std},
          {"unit", one.quantity.unit}, {"weight", one.weight}, {"since", one.since + 1}};
}

Json answer_json(const check::CheckAnswer& answer, const check::CheckHistory& history) {
  Json json = {{"verdict", check::verdict_name(answer.verdict)},
               {"explanation", answer.explanation},
               {"assurance", answer.assurance.json()},
               {"evidence", answer.evidence},
               {"alarm", answer.alarm},
               {"noise_p", answer.noise_p},
               {"checks", history.checks.size()},
               {"readings", history.checks.back().readings}};
  json["changed"] = Json::array();
  for (const check::Change& one : answer.changed) json["changed"].push_back(change_json(one));
  json["not_told_apart"] = answer.not_told_apart;
  json["not_seen"] = answer.not_seen;
  json["resolved"] = Json::array();
  for (const check::Change& one : answer.resolved)
    json["resolved"].push_back({{"name", one.quantity.name}, {"std", one.std}, {"unit", one.quantity.unit}});
  return json;
}

/// The machine file with the changed parameter corrected. Throws LimitNotMet if the change is not a parameter
/// of the machine.
std::string put_right(const CheckArguments& arguments, model::Machine machine, const model::Measurement& rows,
                      const check::CheckAnswer& answer) {
  const model::ParameterSet parameters(machine, rows.states.names(rows.states.setup));
  Eigen::VectorXd values = parameters.get(machine);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].name != answer.changed.front().quantity.name) continue;
    values[static_cast<Eigen::Index>(i)] += answer.changed.front().change;
    parameters.set(machine, values);
    return model::update_machine_text(text::read_file(arguments.machine), machine, false);
  }
  throw text::LimitNotMet(fmt::format(
      "verdict {}, but no machine file is written: {} is no free parameter of {}; diagnose a longer "
      "measurement, and fit",
      check::verdict_name(answer.verdict), answer.changed.front().quantity.name, machine.file));
}

bool has_no_u(const model::Measurement& rows, std::size_t file) {
  return std::any_of(rows.observations.begin(), rows.observations.end(), [&](const model::Observation& one) {
    return rows.file[one.row] == file && !(model::uncertainty_of(rows, one) > 0);
  });
}

void run_check(const CheckArguments& arguments) {
  if (!(arguments.false_alarms > 0 && arguments.false_alarms < 1))
    throw text::InputError({}, fmt::format("{}", arguments.false_alarms),
                           "the rate of false alarms must be between 0 and 1");
  const model::Machine machine = read_model(arguments.machine);
  const model::Measurement rows = model::read_measurement(arguments.measurements, machine,
                                                          simulate::corrections_of_images(arguments.images));
  for (std::size_t file = 0; file < rows.files.size(); ++file)
    if (machine.fitted && has_no_u(rows, file))
      fmt::print(
          stderr,
          "note: {} has no u: the standard uncertainty of its readings is taken as the rms residual of the "
          "fit, {:.3g} um\n",
          rows.files[file], machine.fitted->rms_mm * maths::kUmPerMm);
  check::CheckRecord now = check::record_of(
      machine, rows, arguments.label.empty() ? text::joined(arguments.measurements, " ") : arguments.label);
  check::CheckHistory history{check::identity_of(machine), {}};
  bool anew = false;
  if (!arguments.history.empty() && std::filesystem::exists(arguments.history)) {
    check::CheckHistory before = check::parse_history(text::read_file(arguments.history), arguments.history);
    anew = before.machine != history.machine;
    if (!anew) history = std::move(before);
  }
  history.checks.push_back(std::move(now));
  const check::CheckAnswer answer = check::judge(machine, history.checks, arguments.false_alarms);
  if (!arguments.history.empty()) text::write_file(arguments.history, check::history_text(history));
  Json json = answer_json(answer, history);
  json["history_begun_anew"] = anew;
  write_json(arguments.json, json);
  std::FILE* out = human_stream(arguments.json);
  if (anew)
    fmt::print(out,
               "note: the history file {} contains checks of another fit or of an older version, so this "
               "check begins a new history\n",
               arguments.history);
  fmt::print(out, "verdict: {}. {}\n", check::verdict_name(answer.verdict), answer.explanation);
  fmt::print(out, "evidence for a change: {:.3g} over {} check{}, alarm threshold {:g}\n", answer.evidence,
             history.checks.size(), history.checks.size() == 1 ? "" : "s", answer.alarm);
  if (arguments.output.empty()) return;
  if (answer.verdict == check::CheckVerdict::kChanged)
    text::write_file(arguments.output, put_right(arguments, machine, rows, answer));
  else
    fmt::print(out, "{} is not written: no parameter of the machine changed\n", arguments.output);
}

}  // namespace

void register_check(CLI::App& vernier) {
  auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command =
      vernier.add_subcommand("check", "Check with a short measurement whether a calibration is still valid");
  command->add_option("MACHINE", arguments->machine, "machine file (XML) as `fit` wrote it")
      ->type_name(kReads)
      ->required();
  command->add_option("MEAS", arguments->measurements, "measurement files (CSV) of this check")
      ->type_name(kReads)
      ->required();
  command
      ->add_option("--history", arguments->history,
                   "file with the results of all earlier checks; the command adds this check (and creates "
                   "the file if it does not exist)")
      ->type_name(kWrites);
  command
      ->add_option("--false-alarms", arguments->false_alarms,
                   "rate of false alarms: probability that at least one of all checks reports a change "
                   "although nothing changed")
      ->capture_default_str();
  command->add_option("--label", arguments->label,
                      "name of this check; default: the names of its measurement files");
  command
      ->add_option("-o,--output", arguments->output,
                   "the machine file with the changed parameter corrected, if a parameter changed")
      ->type_name(kWrites);
  command
      ->add_option(
          "--images", arguments->images,
          "folder of correction images, for rows that were measured while a correction image was running")
      ->type_name(kReadsFolder);
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "Each check fits the set-up of the instrument again. The command treats the readings as independent "
      "and\n"
      "normally distributed, with the standard uncertainty u (without u: the rms of the residual of the "
      "fit).\n"
      "Exit status 0 done (for every verdict), 1 bad input (nothing written), 2 -o was given, but the change "
      "is not\n"
      "that of a parameter (the verdict and the history are written, the machine file is not).");
  command->callback([arguments] { run_check(*arguments); });
}

}  // namespace vernier::commands::check_cli
