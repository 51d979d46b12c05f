// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/commands/command.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/commands/fit_findings.h"
#include "tools/compile/certificate.h"
#include "tools/compile/compile.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/work_poses.h"
#include "tools/model/machine_reader.h"
#include "tools/results/fit_findings.h"
#include "tools/results/safety_json.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::commands::compile_cli {
namespace {

struct Arguments {
  std::string machine, directory, json, budget;
  bool certificate = false;
  std::vector<std::string> accept;
};

/// A length such as 0.1um, 100nm, 0.001mm; a bare number is um. Result in um.
double parse_length_um(const std::string& text) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    throw text::InputError("--budget \"" + text + "\": not a length");
  }
  const std::string unit = text.substr(used);
  if (!(value > 0))
    throw text::InputError(fmt::format("--budget \"{}\": the value must be greater than zero", text));
  if (unit.empty() || unit == "um") return value;
  if (unit == "nm") return value / 1000;
  if (unit == "mm") return value * 1000;
  throw text::InputError(fmt::format("--budget \"{}\": unit must be nm, um or mm", text));
}

nlohmann::ordered_json to_json(const compile::OutputBound& b) {
  nlohmann::ordered_json terms = nlohmann::ordered_json::array();
  for (const compile::Contribution& c : b.contributions)
    if (terms.size() < 20)
      terms.push_back({{"term", c.name}, {"source", c.source}, {"bound_um", c.bound_um}});
  if (b.deviation_deg)
    return {{"axis", b.axis}, {"corrects", "direction"}, {"deviation_deg", *b.deviation_deg}};
  return {{"axis", b.axis},
          {"total_um", b.total_um},
          {"linearisation_um", b.linearisation_um},
          {"table_um", b.table_um},
          {"function_um", b.function_um},
          {"rounding_um", b.rounding_um},
          {"input_um", b.input_um},
          {"lag_um", b.lag_um},
          {"second_order_um", b.second_order_um ? nlohmann::ordered_json(*b.second_order_um) : nullptr},
          {"deviation_um", b.deviation_um},
          {"largest_terms", terms}};
}

nlohmann::ordered_json tilt_json(const compile::CompiledMachine& c, const model::Machine& machine) {
  if (!c.tilt || !c.orientation) return nullptr;
  nlohmann::ordered_json axes = nlohmann::ordered_json::array();
  for (const std::size_t axis : c.orientation->axes) axes.push_back(machine.axes[axis].name);
  return {{"axes", axes},
          {"deviation_deg", c.tilt->deviation_deg},
          {"left_deg", c.tilt->left_deg()},
          {"fixed_point_deg", c.tilt->fixed_point_deg},
          {"second_order_deg", c.tilt->second_order_deg},
          {"damped_share", c.orientation->damped.value_or(0)}};
}

nlohmann::ordered_json shares_json(const compile::CompiledMachine& c, const model::Machine& machine) {
  nlohmann::ordered_json shares = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < c.shares.shares.size(); ++i) {
    const model::Axis& axis = machine.axes[c.shares.shares[i].axis];
    shares.push_back({{"effect", c.shares.names[i]},
                      {"axis", axis.name},
                      {"max", c.shares.largest[i] * (axis.rotary ? 1 : 1000)},
                      {"unit", axis.rotary ? "deg" : "um"}});
  }
  return shares;
}

nlohmann::ordered_json to_json(const compile::CompiledMachine& c, const model::Machine& machine) {
  nlohmann::ordered_json bounds = nlohmann::ordered_json::array();
  double total = 0;
  for (const compile::OutputBound& b : c.bounds) {
    bounds.push_back(to_json(b));
    total = std::max(total, b.total_um);
  }
  return {{"bound_um", total},
          {"outputs", bounds},
          {"tilt", tilt_json(c, machine)},
          {"switching", c.switching},
          {"notes", c.notes},
          {"shares", shares_json(c, machine)},
          {"operations", c.program.instructions.size()},
          {"evaluations", c.evaluations},
          {"operations_of_one_evaluation", c.operations_of_one},
          {"registers", c.program.registers.size()},
          {"tables", c.program.tables.size()},
          {"image_bytes", c.image.size()},
          {"fingerprint", text::fingerprint_text(c.fingerprint)}};
}

void print_for_people(std::FILE* out, const compile::CompiledMachine& c, const model::Machine& machine) {
  fmt::print(out, "{}: {} operations a tick, {} tables, {} bytes of image, contributions of {} effects\n",
             machine.name, c.program.instructions.size(), c.program.tables.size(), c.image.size(),
             c.shares.shares.size());
  if (c.evaluations > 1)
    fmt::print(out,
               "{} evaluations of the deviation, each at the position that the previous evaluation gives; "
               "with one evaluation, {} operations\n",
               c.evaluations, c.operations_of_one);
  fmt::print(out, "proved bound of each correction, um:\n");
  fmt::print(out, "  {:<8}{:>10} ={:>12} +{:>8} +{:>10} +{:>9} +{:>8} +{:>8} +{:>11}{:>13}\n", "axis",
             "bound", "neglected", "tables", "functions", "rounding", "inputs", "lags", "2nd order",
             "deviation");
  for (const compile::OutputBound& b : c.bounds) {
    if (b.deviation_deg) {
      fmt::print(out, "  {:<8}corrects the direction by up to {:.4g} deg\n", b.axis, *b.deviation_deg);
      continue;
    }
    const std::string second = b.second_order_um ? fmt::format("{:.4f}", *b.second_order_um) : "not bounded";
    fmt::print(
        out,
        "  {:<8}{:>10.4f} ={:>12.4f} +{:>8.4f} +{:>10.4f} +{:>9.4f} +{:>8.4f} +{:>8.4f} +{:>11}{:>13.1f}\n",
        b.axis, b.total_um, b.linearisation_um, b.table_um, b.function_um, b.rounding_um, b.input_um,
        b.lag_um, second, b.deviation_um);
    if (!b.contributions.empty())
      fmt::print(out, "          largest: {} ({}), {:.4f}\n", b.contributions.front().name,
                 b.contributions.front().source, b.contributions.front().bound_um);
  }
  if (c.tilt)
    fmt::print(out,
               "tilt of the tool: up to {:.4g} deg without correction; {:.2g} deg remain where the "
               "correction is neither damped nor limited (program {:.2g}, 2nd order {:.2g})\n",
               c.tilt->deviation_deg, c.tilt->left_deg(), c.tilt->fixed_point_deg, c.tilt->second_order_deg);
  if (c.bounds.empty()) fmt::print(out, "  no axis has a correction\n");
  if (std::any_of(c.bounds.begin(), c.bounds.end(),
                  [](const compile::OutputBound& b) { return !b.deviation_deg && !b.second_order_um; }))
    fmt::print(
        out,
        "note: the bound does not contain the second order: the change of the error over the correction "
        "itself. The whole error can be larger than the bound\n");
  for (const std::string& step : c.switching)
    fmt::print(out, "note: the bound does not hold at the discontinuity of {}\n", step);
  for (const std::string& note : c.notes) fmt::print(out, "note: {}\n", note);
}

/// The proved error of each axis divided by the largest deviation over the working volume; not evaluated
/// below a micrometre. A bound from intervals alone would be compared with itself.
void judge_bound(safety::SafetySheet& sheet, const compile::CompiledMachine& compiled,
                 const model::Machine& machine, const std::vector<safety::SafetyRule>& accepted) {
  constexpr double kLeast_um = 1;
  const double seen_um =
      1000 * model::deviation(machine, model::work_poses(machine).states).colwise().norm().maxCoeff();
  double worst = 0;
  std::string of;
  for (const compile::OutputBound& b : compiled.bounds) {
    if (b.deviation_deg) continue;
    const double share = b.total_um / std::max(seen_um, kLeast_um);
    if (share > worst) worst = share, of = "axis " + b.axis;
  }
  sheet.judge(safety::SafetyRule::kBound, worst, of, accepted);
}

void run_compile(const Arguments& arguments) {
  const std::string text = text::read_file(arguments.machine);
  compile::CompileOptions options;
  if (!arguments.budget.empty()) options.budget_um = parse_length_um(arguments.budget);
  const model::Machine machine = model::parse_machine(text, arguments.machine);
  repeat_findings(machine);
  const std::vector<safety::SafetyRule> accepted = safety::rules_named(arguments.accept);
  compile::CompiledMachine compiled = compile::compile_machine(machine, text, options);
  safety::SafetySheet sheet = safety::safety_sheet(machine, accepted);
  judge_bound(sheet, compiled, machine, accepted);
  if (!sheet.ok()) throw text::LimitNotMet(sheet.refusal());
  if (options.accepted_rules = sheet.accepted_mask(); options.accepted_rules != 0)
    compiled = compile::compile_machine(machine, text, options);
  nlohmann::ordered_json result = to_json(compiled, machine);
  result["safe_to_run"] = results::safe_to_run_json(sheet);
  result["findings"] = results::findings_json(machine);
  result["assurance"] = results::assurance_of(sheet, machine, text::AssuranceKind::kCompile).json();
  text::make_folder(arguments.directory);
  text::write_file(arguments.directory + "/machine.xml", text);
  text::write_file(arguments.directory + "/equation.h", compiled.header);
  text::write_file(arguments.directory + "/equation.cpp", compiled.source);
  text::write_file(arguments.directory + "/bound.json", result.dump(2) + "\n");
  text::write_file(arguments.directory + "/machine.vimg", {compiled.image.begin(), compiled.image.end()});
  if (arguments.certificate)
    text::write_file(arguments.directory + "/bound.g", compile::print_certificate(machine, compiled));
  write_json(arguments.json, result);
  std::FILE* const out = human_stream(arguments.json);
  print_for_people(out, compiled, machine);
  results::print_safety(out, sheet);
  fmt::print(out, "written to {}: machine.vimg, machine.xml, equation.h, equation.cpp, bound.json{}\n",
             arguments.directory, arguments.certificate ? ", bound.g" : "");
}

}  // namespace

void register_compile(CLI::App& vernier) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = vernier.add_subcommand(
      "compile",
      "Compile a machine file to a correction image (fixed point) and C++ with a proved error bound");
  command->add_option("machine", arguments->machine, "machine file (XML)")->type_name(kReads)->required();
  command
      ->add_option("-o,--output", arguments->directory,
                   "directory for machine.xml, machine.vimg, equation.h/.cpp, bound.json")
      ->type_name(kWritesFolder)
      ->required();
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->add_option(
      "--budget", arguments->budget,
      "largest permitted error bound of an axis (nm, um, mm; a number without a unit is in um); if a proved "
      "bound is larger, the command writes nothing and ends with exit status 2");
  command->add_flag("--certificate", arguments->certificate,
                    "also write bound.g, a script of the compiled program: Gappa (gappa DIR/bound.g) proves "
                    "the error bound independently of Vernier");
  command
      ->add_option("--accept", arguments->accept,
                   "name of a rule of the safety sheet (\"safe to run?\", tools/docs/safety.md) that you "
                   "override; the image records the name; may be repeated")
      ->check(rule_words());
  command->footer(
      "The safety sheet tests the correction over <volume> (else over the axis ranges), with the <tools> of "
      "the machine file.\n"
      "Exit status 0 done, 1 bad input, 2 the error bound exceeds the budget or a rule of the safety sheet "
      "fails: nothing written.");
  command->callback([arguments] { run_compile(*arguments); });
}

}  // namespace vernier::commands::compile_cli
