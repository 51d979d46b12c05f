// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/out/exporting.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/exchange/three_axes.h"
#include "tools/kinematics/at.h"
#include "tools/results/fit_findings.h"
#include "tools/safety/safety_sheet.h"
#include "tools/text/assurance.h"
#include "tools/text/error.h"

namespace vernier::commands::exchange_cli {

namespace {

/// The errors of an export are errors of the model, not of the machine.
constexpr const char* kNotMeasured =
    "The machine was not measured with these files: an error that the model does not contain remains. "
    "Measure the machine again while the files are active.";

/// Assurance of an export: the machine may run with the correction, all of its errors are in the files, and
/// the error between the lines is within the tolerance.
text::Assurance assurance_of(const model::Machine& machine, const ExchangeArguments& arguments,
                             const std::vector<exchange::LeftOut>& left_out,
                             const std::vector<AxisLines>& axes) {
  text::Assurance assurance(text::AssuranceKind::kExport);
  results::add_findings(assurance, machine);
  assurance.require("safe-to-run", true,
                    "Every rule of the safety sheet (\"safe to run?\") is met or accepted by the user.");
  double left_um = 0;
  for (const exchange::LeftOut& one : left_out) left_um = std::max(left_um, one.um);
  assurance.at_most("left-out", left_um, exchange::kNothing_um,
                    "Largest error of the machine that the format cannot express, um.");
  for (const AxisLines& one : axes)
    assurance.at_most(
        "between-lines-" + one.axis, one.worst_um, arguments.tolerance_um,
        fmt::format("Largest error between the lines of {}, um, at {} positions.", one.axis, one.probed));
  assurance.not_covered(kNotMeasured);
  for (const std::string& rule : arguments.accept)
    assurance.not_covered(fmt::format("The user accepted a rule of the safety sheet (--accept): {}.", rule));
  return assurance;
}

}  // namespace

void require_safe(const model::Machine& machine, const ExchangeArguments& arguments, bool not_of_board) {
  std::vector<safety::SafetyRule> accepted = safety::rules_named(arguments.accept);
  if (not_of_board) accepted.push_back(safety::SafetyRule::kMaxCorrection);
  const safety::SafetySheet sheet = safety::safety_sheet(machine, accepted);
  if (!sheet.ok()) throw text::LimitNotMet(sheet.refusal());
}

void finish(const model::Machine& machine, const ExchangeArguments& arguments, const char* format,
            const std::vector<exchange::LeftOut>& left_out, const Json& files,
            const std::vector<AxisLines>& axes, bool exported, const Json& extra) {
  Json left = Json::array();
  // A plausible size of an error that nobody measured is no number for a program or a page.
  for (const exchange::LeftOut& one : left_out)
    left.push_back({{"what", one.what}, {"um", one.measured ? Json(one.um) : Json(nullptr)}});
  Json json = {{"format", format}, {"files", files}, {"left_out", left}};
  for (const AxisLines& one : axes)
    json["axes"][one.axis] = {{"lines", one.lines}, {"worst_um", one.worst_um}, {"probed", one.probed}};
  for (const auto& [key, value] : extra.items()) json[key] = value;
  if (exported) json["assurance"] = assurance_of(machine, arguments, left_out, axes).json();
  write_json(arguments.json, json);
  std::FILE* out = human_stream(arguments.json);
  for (const AxisLines& one : axes)
    fmt::print(out, "{}: {} lines, error between them at most {:.3g} um ({} positions evaluated)\n", one.axis,
               one.lines, one.worst_um, one.probed);
  for (const exchange::LeftOut& one : left_out)
    fmt::print(out, "left out: {}: {}\n", one.what,
               one.measured ? fmt::format("up to {:.4g} um", one.um) : "size unknown");
  if (exported) fmt::print(out, "{}\n", kNotMeasured);
  for (const Json& file : files) fmt::print(out, "{}\n", file.get<std::string>());
}

model::States state_of(const model::Machine& machine, const ExchangeArguments& arguments) {
  std::string words;
  for (const model::Axis& axis : machine.axes)
    if (axis.min && axis.max) words += fmt::format("{}={},", axis.name, (*axis.min + *axis.max) / 2);
  words += arguments.at;
  if (!words.empty() && words.back() == ',') words.pop_back();
  return kinematics::state_at(machine, words);
}

Json write_folder(const ExchangeArguments& arguments, const std::vector<exchange::ConfigurationFile>& files) {
  Json paths = Json::array();
  for (const exchange::ConfigurationFile& file : files) {
    const std::string path = arguments.output + "/" + file.name;
    text::make_folder(path.substr(0, path.rfind('/')));
    text::write_file(path, file.text);
    paths.push_back(path);
  }
  return paths;
}

Json three_json(const std::array<double, 3>& values) {
  return {{"x", values[0]}, {"y", values[1]}, {"z", values[2]}};
}

std::vector<exchange::LeftOut> remaining(const std::array<double, 3>& after_um) {
  std::vector<exchange::LeftOut> left;
  for (std::size_t i = 0; i < 3; ++i)
    if (after_um[i] > exchange::kNothing_um)
      left.push_back(
          {fmt::format("error along {} by the model that remains with the files, between the points as well",
                       exchange::kLetters[i]),
           after_um[i]});
  return left;
}

void refuse_without_errors(const ExchangeArguments& arguments, double before_um) {
  if (before_um > 0) return;
  throw text::InputError(
      {arguments.machine, 0}, "",
      "the model of this machine has no errors, and tables of zeros would replace those of the controller: "
      "fit the machine to a measurement first (vernier fit MACHINE ROWS -o FITTED), and export the fitted "
      "file");
}

void print_rms(const ExchangeArguments& arguments, std::size_t positions, double before_um, double after_um) {
  fmt::print(human_stream(arguments.json),
             "the model predicts an error of the tool point of {:.4g} um rms in the working volume ({} "
             "positions). The files hold the model to {:.4g} um rms; that is not the accuracy of the "
             "machine.\n",
             before_um, positions, after_um);
}

CLI::App* add_export(CLI::App* parent, const char* kind, const char* what, const char* output_type,
                     const char* output, const std::shared_ptr<ExchangeArguments>& arguments) {
  CLI::App* command = parent->add_subcommand(kind, what);
  command->add_option("MACHINE", arguments->machine, "machine file (XML)")->type_name(kReads)->required();
  command->add_option("-o,--output", arguments->output, output)->type_name(output_type)->required();
  command->add_flag("--leave-out", arguments->leave_out,
                    "write what the format can represent, and list what it cannot");
  command->add_option("--at", arguments->at,
                      "values of the other axes and inputs: \"Y=0,T=25\"; default: middle of the ranges");
  command
      ->add_option("--accept", arguments->accept,
                   "name of a rule of the safety sheet (\"safe to run?\", tools/docs/safety.md) that you "
                   "override; may be repeated")
      ->check(rule_words());
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  return command;
}

}  // namespace vernier::commands::exchange_cli
