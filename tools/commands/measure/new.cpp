// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "tools/commands/command.h"
#include "tools/create/machine_file.h"
#include "tools/create/survey_template.h"
#include "tools/create/urdf.h"
#include "tools/format/readings.h"
#include "tools/model/machine_reader.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::commands::new_cli {
namespace {

struct NewArguments {
  std::string type, output, measurements, json, name, tool, dh, urdf, tip, reading = "point", errors = "all";
  std::string tool_side, work_side;
  std::vector<std::string> axes, centres, joints, artefacts, stations;
  bool reflector = false;
};

/// Names the types of machines in the help. It accepts any word: plan_machine gives a reason for a delta.
CLI::Validator machine_type() {
  std::vector<std::string> names;
  for (const create::MachineType& type : create::machine_types()) names.emplace_back(type.name);
  return {[](std::string&) { return std::string(); }, "{" + text::joined(names, ",") + "}"};
}

std::array<double, 3> point_of(const std::string& text, char separator, const std::string& what) {
  const std::vector<std::string> parts = text::parts_of(text, separator);
  std::array<double, 3> point{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto number = k < parts.size() ? text::parse_number(parts[k]) : std::nullopt;
    if (!number || parts.size() != 3)
      throw text::InputError(fmt::format("{} {}: three lengths in mm, such as {}", what, text,
                                         separator == ',' ? "0,0,-120" : "C:250:200:0"));
    point[k] = *number;
  }
  return point;
}

std::vector<create::DhRow> arm_of(const NewArguments& arguments) {
  if (!arguments.dh.empty() && !arguments.joints.empty())
    throw text::InputError("--dh and --joint both describe the arm: give only one of the two options");
  if (!arguments.dh.empty()) return create::parse_dh_table(text::read_file(arguments.dh), arguments.dh);
  std::vector<create::DhRow> rows;
  for (const std::string& words : arguments.joints) rows.push_back(create::parse_dh_row(words));
  return rows.empty() ? create::default_arm() : rows;
}

std::vector<create::PlannedAxis> axes_of(const NewArguments& arguments) {
  std::vector<create::PlannedAxis> axes;
  for (const std::string& words : arguments.axes) axes.push_back(create::parse_planned_axis(words));
  return axes;
}

create::MachinePlan plan_of_urdf(const NewArguments& arguments, const CLI::App& command) {
  if (arguments.type != "robot") throw text::InputError("--urdf: this option is only for the type robot");
  for (const char* option : {"--dh", "--joint", "--axis"})
    if (command.count(option) > 0)
      throw text::InputError(
          fmt::format("{}: not allowed together with --urdf, which describes the arm", std::string(option)));
  const create::UrdfArm arm =
      create::parse_urdf(text::read_file(arguments.urdf), arguments.urdf, arguments.tip);
  create::MachinePlan plan = create::plan_robot(arm.axes, arm.rows);
  plan.name = arm.name;
  plan.base = arm.base;
  plan.link = arm.tip;
  plan.link_frame = arm.tip_frame;
  plan.tool =
      arm.tool(arguments.tool.empty() ? std::array<double, 3>{} : point_of(arguments.tool, ',', "--tool"));
  return plan;
}

create::MachinePlan plan_of_words(const NewArguments& arguments, const CLI::App& command) {
  std::vector<create::PlannedAxis> axes = axes_of(arguments);
  const auto order = [&](const char* option, const std::string& names) {
    return command.count(option) > 0 ? std::optional(text::parts_of(names, ',')) : std::nullopt;
  };
  create::MachinePlan plan;
  if (arguments.type == "robot") {
    for (const char* option : {"--tool-side", "--work-side", "--centre"})
      if (command.count(option) > 0)
        throw text::InputError(fmt::format(
            "{}: this option is not for the type robot; --dh or --joint describes the chain of a robot",
            std::string(option)));
    plan = create::plan_robot(std::move(axes), arm_of(arguments));
  } else {
    for (const char* option : {"--dh", "--joint"})
      if (command.count(option) > 0)
        throw text::InputError(
            fmt::format("{}: this option is only for the type robot", std::string(option)));
    plan = create::plan_machine(arguments.type, std::move(axes), order("--tool-side", arguments.tool_side),
                                order("--work-side", arguments.work_side));
  }
  // A tool of some length in the usual direction: without a length, angles of the last axis would have no
  // effect.
  plan.tool = {0, 0, plan.arm.empty() ? -100.0 : 100.0};
  if (!arguments.tool.empty()) plan.tool = point_of(arguments.tool, ',', "--tool");
  for (const std::string& words : arguments.centres) {
    const auto colon = words.find(':');
    const std::string name = words.substr(0, colon);
    bool found = false;
    for (create::PlannedAxis& axis : plan.axes)
      if (axis.name == name && axis.rotary() && colon != std::string::npos) {
        axis.centre = point_of(words.substr(colon + 1), ':', "--centre");
        found = true;
      }
    if (!found)
      throw text::InputError(
          fmt::format("--centre {}: the value must be NAME:X:Y:Z, where NAME is a rotary axis", words));
  }
  return plan;
}

create::MachinePlan plan_of(const NewArguments& arguments, const CLI::App& command) {
  if (arguments.urdf.empty() && !arguments.tip.empty()) throw text::InputError("--tip: a link of --urdf");
  create::MachinePlan plan =
      arguments.urdf.empty() ? plan_of_words(arguments, command) : plan_of_urdf(arguments, command);
  if (!arguments.name.empty()) plan.name = arguments.name;
  plan.positioning_only = arguments.errors == "positioning";
  plan.square_only = arguments.errors == "square";
  plan.reflector = arguments.reflector;
  if (!plan.arm.empty() && !arguments.stations.empty())
    throw text::InputError("--stations: this option is not for the type robot, whose axes have no tables");
  for (const std::string& words : arguments.stations) create::plan_stations(plan.axes, words);
  for (const std::string& words : arguments.artefacts)
    plan.artefacts.push_back(create::parse_planned_artefact(words));
  // Readings of the column `on` need an object: a plane such as the bed of a printer, if none is stated.
  if (plan.artefacts.empty() &&
      create::reading_of(arguments.reading).list().front() == format::ReadingForm::kOn)
    plan.artefacts.push_back({"bed", "plane"});
  if ((plan.positioning_only || plan.square_only) && !plan.arm.empty())
    throw text::InputError(
        fmt::format("--errors {} is only for machines with linear axes; a robot always has all errors of its "
                    "joints and links",
                    arguments.errors));
  return plan;
}

/// "point: tracker …; length: ball bar …".
std::string reading_help() {
  std::vector<std::string> list;
  for (const format::SurveyReading& reading : format::kSurveyReadings)
    list.push_back(std::string(reading.word) + ": " + reading.instruments);
  return text::joined(list, "; ");
}

void run_new(const NewArguments& arguments, const CLI::App& command) {
  const create::MachinePlan plan = plan_of(arguments, command);
  const std::string text = create::machine_file(plan);
  const model::Machine machine = model::parse_machine(text, arguments.output);
  if (!arguments.measurements.empty()) text::require_place(arguments.measurements);
  const std::string survey = create::survey_template(machine, create::reading_of(arguments.reading));
  text::write_file(arguments.output, text);
  if (!arguments.measurements.empty())
    text::write_file(arguments.measurements,
                     arguments.measurements.ends_with(".xlsx") ? create::survey_workbook(survey) : survey);
  nlohmann::ordered_json json = {
      {"type", plan.type}, {"machine", arguments.output}, {"drawing", create::drawing(plan)}};
  for (const model::Axis& axis : machine.axes) json["axes"].push_back(axis.name);
  json["measurements"] = arguments.measurements.empty() ? nlohmann::ordered_json(nullptr)
                                                        : nlohmann::ordered_json(arguments.measurements);
  write_json(arguments.json, json);
  std::FILE* out = human_stream(arguments.json);
  fmt::print(out, "{}\n", create::drawing(plan));
  fmt::print(out, "{}: {} axes, {} tables, tool {} {} {} mm\n", arguments.output, machine.axes.size(),
             machine.tables.size(), plan.tool[0], plan.tool[1], plan.tool[2]);
  if (plan.arm == create::default_arm())
    fmt::print(out,
               "the machine file has the arm lengths of a UR10e; give the lengths of your robot with --dh "
               "FILE or --joint\n");
  const std::string meas = arguments.measurements.empty() ? "MEAS.csv" : arguments.measurements;
  if (!arguments.measurements.empty())
    fmt::print(out, "{}: rows to be measured, with empty cells for the readings\n", meas);
  if (meas.ends_with(".xlsx"))
    fmt::print(out, "next: fill in the readings, then vernier import table {} -o survey.csv --machine {}\n",
               meas, arguments.output);
  else
    fmt::print(out, "next: vernier lint {0} {1}, then vernier fit {0} {1} -o fitted.xml\n", arguments.output,
               meas);
}

}  // namespace

void register_new(CLI::App& vernier) {
  auto arguments = std::make_shared<NewArguments>();
  CLI::App* command =
      vernier.add_subcommand("new", "Create a machine file and an empty table for its survey");
  command->add_option("TYPE", arguments->type, "type of the machine")->check(machine_type())->required();
  command
      ->add_option("--axis", arguments->axes,
                   "axis: NAME:MIN:MAX in mm or deg; repeat the option for each axis. If the name does not "
                   "state the direction, add :X :Y :Z (linear axis along X, Y, Z) or :A :B :C (rotary axis "
                   "about X, Y, Z). Add :wrap for a rotary axis without end stops")
      ->allow_extra_args(false);
  command->add_option("-o,--output", arguments->output, "the machine file (XML)")
      ->type_name(kWrites)
      ->required();
  command
      ->add_option("--measurements", arguments->measurements,
                   "also write an empty measurement file for the readings: CSV, or a workbook (.xlsx)")
      ->type_name(kWrites);
  command
      ->add_option(
          "--stations", arguments->stations,
          "NAME=STEP or NAME=POSITION,POSITION,...: stations of the table of an axis, mm or deg: X=25; "
          "repeat for each axis (default: 4 to 7 parts of the travel)")
      ->allow_extra_args(false);
  command
      ->add_option("--errors", arguments->errors,
                   "parameters that a fit may estimate: all, or positioning (errors along each axis, for an "
                   "interferometer or a dial gauge), or square (squareness of Y to X and scales of X and Y, "
                   "for the distances of a printed square)")
      ->check(CLI::IsMember({"all", "positioning", "square"}))
      ->capture_default_str();
  command
      ->add_option(
          "--reading", arguments->reading,
          "quantities that the survey reads: " + format::survey_words("or") + " (" + reading_help() + ")")
      ->capture_default_str();
  command
      ->add_option(
          "--artefact", arguments->artefacts,
          "NAME:TYPE: an object that the tool point touches (column on), of type point, line, plane, "
          "sphere or cylinder: bed:plane for the bed of a 3D printer; repeat for each object")
      ->allow_extra_args(false);
  command->add_flag("--reflector", arguments->reflector,
                    "the readings are those of a reflector at an unknown place on the tool: this place is "
                    "estimated (ToolShift), and is no error of the machine");
  command->add_option("--tool", arguments->tool,
                      "tool point in the frame of the last axis that carries the tool, mm: 0,0,-120");
  command->add_option("--name", arguments->name, "name of the machine");
  command->add_option("--tool-side", arguments->tool_side,
                      "axes that carry the tool, in the order from the bed to the tool: Y,X,Z");
  command->add_option("--work-side", arguments->work_side,
                      "axes that carry the workpiece, in the order from the bed to the workpiece: A,C");
  command
      ->add_option("--centre", arguments->centres,
                   "NAME:X:Y:Z: a point on the line of a rotary axis, mm; repeat for each axis")
      ->allow_extra_args(false);
  command
      ->add_option("--dh", arguments->dh,
                   "robot: table of the rows of Denavit and Hartenberg (CSV): "
                   "theta[deg],d[mm],a[mm],alpha[deg] and type (R revolute, P prismatic)")
      ->type_name(kReads);
  command
      ->add_option("--joint", arguments->joints,
                   "robot: one row of Denavit and Hartenberg: theta,d,a,alpha (for a prismatic joint "
                   "P,theta,d,a,alpha); repeat the option for each joint")
      ->allow_extra_args(false);
  command
      ->add_option("--urdf", arguments->urdf,
                   "robot: description of the arm (URDF); the command reads rows, names and limits of the "
                   "joints from this file")
      ->type_name(kReads);
  command->add_option(
      "--tip", arguments->tip,
      "last link of the arm in the URDF (default: the only last link); --tool is in the frame of this link");
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "The type of the machine determines the order of the axes and whether each axis carries the tool or "
      "the workpiece;\n"
      "the command prints this chain, and --tool-side and --work-side change it. A robot without --dh, "
      "--joint and --urdf\n"
      "has six joints with the lengths of a UR10e. A machine file cannot describe a delta robot or a hexapod "
      "(closed loops).");
  command->callback([arguments, command] { run_new(*arguments, *command); });
}

}  // namespace vernier::commands::new_cli
