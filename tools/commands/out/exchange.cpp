// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/commands/out/exporting.h"
#include "tools/compile/compile.h"
#include "tools/exchange/component_csv.h"
#include "tools/exchange/left_out.h"
#include "tools/exchange/linuxcnc_folder.h"
#include "tools/exchange/screw_comp.h"
#include "tools/exchange/table_text.h"
#include "tools/model/machine_reader.h"
#include "tools/safety/safety_sheet.h"

namespace vernier::commands::exchange_cli {
namespace {

std::size_t axis_named(const model::Machine& machine, const std::string& name) {
  const auto axis = machine.find_axis(name);
  if (!axis) throw text::InputError({machine.file, 0}, name, "the machine has no axis of this name");
  return *axis;
}

/// The folder that brings the component into a configuration: HAL file, INI lines, README, image.
std::vector<exchange::ConfigurationFile> configuration(const model::Machine& machine,
                                                       const ExchangeArguments& arguments) {
  const std::string text = text::read_file(arguments.machine);
  compile::CompileOptions options;
  options.accepted_rules =
      safety::safety_sheet(machine, safety::rules_named(arguments.accept)).accepted_mask();
  const compile::CompiledMachine compiled = compile::compile_machine(machine, text, options);
  const std::string folder =
      std::filesystem::absolute(arguments.output).lexically_normal().filename().string();
  std::vector<exchange::ConfigurationFile> outputs =
      exchange::linuxcnc_folder(machine, folder.empty() ? "vernier" : folder);
  outputs.push_back({"image/machine.vimg", {compiled.image.begin(), compiled.image.end()}});
  outputs.push_back({"image/machine.xml", text});
  return outputs;
}

void export_component(const ExchangeArguments& arguments) {
  const model::Machine machine = read_model(arguments.machine);
  require_safe(machine, arguments);
  const std::vector<exchange::ConfigurationFile> outputs = configuration(machine, arguments);
  finish(machine, arguments, "linuxcnc", {}, write_folder(arguments, outputs));
}

void export_screw(const ExchangeArguments& arguments) {
  if (arguments.component) return export_component(arguments);
  const model::Machine machine = read_model(arguments.machine);
  const model::States at = state_of(machine, arguments);
  const auto type = static_cast<exchange::ScrewType>(arguments.type);
  std::vector<std::size_t> axes = kinematics::linear_axes(machine);
  if (!arguments.axis.empty()) axes = {axis_named(machine, arguments.axis)};
  if (machine.axes[axes.at(0)].rotary)
    throw text::InputError({machine.file, 0}, arguments.axis,
                           "this axis is rotary; only linear axes can be exported");
  std::vector<exchange::LeftOut> left_out;
  for (const std::size_t axis : axes)
    for (exchange::LeftOut& one : exchange::beyond_own_axis(machine, axis, at))
      left_out.push_back(std::move(one));
  if (arguments.axis.empty() && !left_out.empty() && !arguments.leave_out) {
    // The component applies the whole machine file.
    fmt::print(stderr, "note: no screw-compensation file: {}\n",
               exchange::left_out_in_words("a screw-compensation file", left_out));
    return export_component(arguments);
  }
  exchange::refuse(machine, "a screw-compensation file", left_out, arguments.leave_out);
  require_safe(machine, arguments);
  std::vector<std::string> texts;
  std::vector<AxisLines> lines;
  for (const std::size_t axis : axes) {
    const exchange::ScrewTable table = exchange::screw_table(machine, axis, at, arguments.tolerance_um);
    texts.push_back(exchange::screw_text(table.points, type));
    lines.push_back({machine.axes[axis].name, table.points.size(), table.probed, table.worst_um});
  }
  Json files = Json::array();
  if (!arguments.axis.empty()) {
    files = {arguments.output};
  } else {
    text::make_folder(arguments.output);
    for (const std::size_t axis : axes)
      files.push_back(arguments.output + "/" + machine.axes[axis].name + ".comp");
  }
  std::vector<exchange::ConfigurationFile> outputs;
  std::string without;
  try {
    if (arguments.axis.empty()) outputs = configuration(machine, arguments);
  } catch (const text::InputError& error) {
    without = error.what();  // the tables can do with less than an image
  }
  for (std::size_t i = 0; i < axes.size(); ++i) text::write_file(files[i].get<std::string>(), texts[i]);
  for (const Json& file : write_folder(arguments, outputs)) files.push_back(file);
  if (!without.empty()) fmt::print(stderr, "note: no configuration of the component: {}\n", without);
  finish(machine, arguments, "linuxcnc", left_out, files, lines);
}

void export_tables(const ExchangeArguments& arguments, bool isg) {
  const model::Machine machine = read_model(arguments.machine);
  if (machine.tables.empty())
    throw text::InputError({machine.file, 0}, "", "this machine has no table to export");
  const std::vector<exchange::LeftOut> left_out =
      exchange::beyond_tables(machine, state_of(machine, arguments));
  exchange::refuse(machine, isg ? "a list of component errors" : "a CSV file per axis", left_out,
                   arguments.leave_out);
  require_safe(machine, arguments);
  Json files = Json::array();
  if (isg) {
    files.push_back(arguments.output);
    text::write_file(arguments.output, exchange::isg_csv(machine));
  } else {
    text::make_folder(arguments.output);
    for (const model::Table& table : machine.tables) {
      files.push_back(arguments.output + "/" + machine.axes[table.axis].name + ".csv");
      text::write_file(files.back().get<std::string>(), exchange::axis_csv(machine, table));
    }
  }
  finish(machine, arguments, isg ? "isg-csv" : "axis-csv", left_out, files);
}

void import_tables(const ExchangeArguments& arguments, const std::string& kind) {
  const std::string text = text::read_file(arguments.machine), source = text::read_file(arguments.file);
  const model::Machine machine = model::parse_machine(text, arguments.machine);
  std::string result = text;
  if (kind == "linuxcnc") {
    const std::size_t axis = axis_named(machine, arguments.axis);
    result = exchange::screw_into_machine(
        text, machine, axis,
        exchange::parse_screw(source, arguments.file, static_cast<exchange::ScrewType>(arguments.type)),
        arguments.reversal);
  } else {
    const std::vector<model::Table> tables =
        kind == "isg-csv"
            ? exchange::parse_isg_csv(source, arguments.file, machine)
            : std::vector<model::Table>{exchange::parse_axis_csv(source, arguments.file, machine)};
    for (const model::Table& table : tables) {
      exchange::check_used(machine, table);
      result = exchange::set_table(result, model::parse_machine(result, arguments.machine), table);
    }
  }
  text::write_file(arguments.output, result);
  finish(machine, arguments, kind.c_str(), {}, Json::array({arguments.output}), {}, false);
}

void add_type(CLI::App* command, ExchangeArguments& arguments) {
  command
      ->add_option("--type", arguments.type,
                   "COMP_FILE_TYPE: 0 contains the actual position of the axis, 1 the value added to the "
                   "command (trim)")
      ->check(CLI::IsMember({0, 1}))
      ->capture_default_str();
}

CLI::App* add_import(CLI::App* parent, const char* kind, const char* what,
                     const std::shared_ptr<ExchangeArguments>& arguments) {
  CLI::App* command = parent->add_subcommand(kind, what);
  command->add_option("FILE", arguments->file, "file to read")->type_name(kReads)->required();
  command->add_option("--machine", arguments->machine, "machine file that receives the tables")
      ->type_name(kReads)
      ->required();
  command->add_option("-o,--output", arguments->output, "machine file to write")
      ->type_name(kWrites)
      ->required();
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->callback([arguments, name = std::string(kind)] { import_tables(*arguments, name); });
  return command;
}

}  // namespace

void register_export(CLI::App& vernier) {
  CLI::App* parent =
      vernier.add_subcommand("export", "Write the corrections of a machine in the format of a controller");
  parent->require_subcommand(1);
  parent->footer(
      "If the tables of a format cannot express an error of the machine, the command refuses the format and "
      "names the reason;\n"
      "with --leave-out it writes the errors that the tables can express. For siemens, heidenhain, fanuc, "
      "printers and robots\n"
      "the command writes the files and prints the remaining error. Exit status 0 done, 1 bad input, 2 the "
      "sheet\n"
      "\"safe to run?\" fails, or the tolerance needs more lines than the controller can store: nothing "
      "written.");
  auto screw = std::make_shared<ExchangeArguments>();
  CLI::App* linuxcnc = add_export(
      parent, "linuxcnc", "LinuxCNC: screw compensation (COMP_FILE), and a configuration of its component",
      kWritesFolder,
      "output directory, with one file for each axis and the configuration; with --axis: name of the file",
      screw);
  linuxcnc->add_flag("--component", screw->component,
                     "write only the configuration of the component `vernier`; this component can correct "
                     "every machine (tools/docs/linuxcnc.md)");
  linuxcnc->add_option("--axis", screw->axis, "this axis only");
  linuxcnc
      ->add_option("--tolerance", screw->tolerance_um,
                   "largest permitted error of the interpolation between two lines of the table, um")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_type(linuxcnc, *screw);
  linuxcnc->callback([screw] { export_screw(*screw); });
  auto plain = std::make_shared<ExchangeArguments>();
  add_export(parent, "axis-csv", "One CSV file for each axis, with units", kWritesFolder, "directory", plain)
      ->callback([plain] { export_tables(*plain, false); });
  auto isg = std::make_shared<ExchangeArguments>();
  add_export(parent, "isg-csv", "Component errors for ISG and Beckhoff volumetric compensation (ISG_CSV)",
             kWrites, "file", isg)
      ->callback([isg] { export_tables(*isg, true); });
  add_printer_exports(parent);
  add_controller_exports(parent);
  add_robot_exports(parent);
}

void register_import_tables(CLI::App& vernier) {
  CLI::App* parent =
      vernier.add_subcommand("import-tables", "Read a controller's tables into a machine file");
  parent->require_subcommand(1);
  auto screw = std::make_shared<ExchangeArguments>();
  CLI::App* linuxcnc = add_import(parent, "linuxcnc", "LinuxCNC screw compensation (COMP_FILE)", screw);
  linuxcnc->add_option("--axis", screw->axis, "name of the axis to which the file belongs")->required();
  linuxcnc->add_option(
      "--reversal", screw->reversal,
      "constant (static) k of a term k*dir: import-tables sets this constant to half of the reversal");
  add_type(linuxcnc, *screw);
  add_import(parent, "axis-csv", "CSV of one axis, with units", std::make_shared<ExchangeArguments>());
  add_import(parent, "isg-csv", "Component errors of ISG and Beckhoff volumetric compensation (ISG_CSV)",
             std::make_shared<ExchangeArguments>());
}

}  // namespace vernier::commands::exchange_cli
