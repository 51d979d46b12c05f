// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <pugixml.hpp>

#include "tools/commands/command.h"
#include "tools/create/machine_plan.h"
#include "tools/effects/insertion.h"
#include "tools/exchange/table_text.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/model/parameters.h"
#include "tools/text/numbers.h"
#include "tools/text/xml_text.h"
#include "tools/workbench/files/excluded.h"
#include "tools/workbench/files/values.h"

namespace vernier::commands::edit_cli {
namespace {

struct ExcludeArguments {
  std::string measurement, output, lines, reason = "by hand", json;
  bool restore = false;
};

void run_exclude(const ExcludeArguments& arguments) {
  std::string text = text::read_file(arguments.measurement);
  if (!arguments.lines.empty()) {
    if (arguments.output.empty())
      throw text::InputError("-o is missing: give the name of the new measurement file");
    const auto lines = workbench::parse_lines(arguments.lines);
    text = arguments.restore ? workbench::restore_rows(text, arguments.measurement, lines)
                             : workbench::exclude_rows(text, arguments.measurement, lines, arguments.reason);
    text::write_file(arguments.output, text);
  }
  nlohmann::ordered_json json = {{"excluded", nlohmann::ordered_json::array()}};
  std::FILE* const out = human_stream(arguments.json);
  for (const workbench::ExcludedRow& row : workbench::excluded_rows(text)) {
    json["excluded"].push_back({{"line", row.line}, {"reason", row.reason}});
    fmt::print(out, "line {}: {}\n", row.line, row.reason);
  }
  fmt::print(out, "{} rows excluded by hand\n", json["excluded"].size());
  write_json(arguments.json, json);
}

struct SetArguments {
  std::string machine, output, json;
  std::vector<std::string> values, artefacts, stations;
  bool reflector = false, measured_travel = false;
};

/// The machine text with `lines` at the end of an element.
std::string with_lines(const std::string& text, const std::string& file, const char* element,
                       const std::string& lines) {
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  const pugi::xml_node found = effects::element_named(document, element);
  if (!found)
    throw text::InputError({file, 0}, element,
                           fmt::format("the machine file has no <{}> element; add one", element));
  return text::apply_edits(text, {effects::at_end_of(text, found, lines)});
}

/// The machine text with <ToolShift/> at the end of <static>.
std::string with_reflector(const std::string& text, const SetArguments& arguments) {
  if (!arguments.reflector) return text;
  if (!model::parse_machine(text, arguments.machine).tool_shifts.empty())
    throw text::InputError({arguments.machine, 0}, "ToolShift",
                           "the machine file already declares what is at an unknown place on the tool");
  return with_lines(text, arguments.machine, "static", create::kReflectorLine);
}

/// The machine text with artefacts "NAME:TYPE" at the end of <variables>.
std::string with_artefacts(const std::string& text, const SetArguments& arguments) {
  if (arguments.artefacts.empty()) return text;
  std::string lines;
  for (const std::string& words : arguments.artefacts) {
    const create::PlannedArtefact one = create::parse_planned_artefact(words);
    lines +=
        fmt::format("    <artefact name=\"{}\" type=\"{}\"/>\n", text::escape_attribute(one.name), one.type);
  }
  return with_lines(text, arguments.machine, "variables", lines);
}

/// Reduces the travel of each axis to the range in which the last fit measured it. Returns the axes that
/// changed. An axis that stood still keeps its travel.
std::vector<std::size_t> take_measured_travel(model::Machine& machine) {
  if (!machine.fitted)
    throw text::InputError({machine.file, 0}, "",
                           "no fit wrote this machine file: it has no measured range (--measured-travel)");
  std::vector<std::size_t> changed;
  for (const model::FitRecord::Range& measured : machine.fitted->measured) {
    const auto index = machine.find_axis(measured.name);
    if (!index || !(measured.max > measured.min)) continue;
    model::Axis& axis = machine.axes[*index];
    const double low = std::max(measured.min, axis.min.value_or(measured.min)),
                 high = std::min(measured.max, axis.max.value_or(measured.max));
    if (!(high > low))
      throw text::InputError(
          {machine.file, axis.line}, axis.name,
          fmt::format("the axis was measured from {:g} to {:g}, outside its travel: the rows "
                      "are of another machine, or have another zero or unit",
                      measured.min, measured.max));
    if (axis.min == low && axis.max == high) continue;
    axis.min = low;
    axis.max = high;
    changed.push_back(*index);
  }
  return changed;
}

/// A table with other stations.
struct NewStations {
  std::string axis;
  std::size_t before = 0, after = 0;  // number of stations
};

/// Gives tables the stations that the arguments state, with the values that the tables have there. The record
/// of the last fit is about the former stations, and is removed.
std::vector<NewStations> take_stations(std::string& text, const SetArguments& arguments) {
  std::vector<NewStations> list;
  if (!arguments.stations.empty()) text = model::without_fit_record(text);
  for (const std::string& words : arguments.stations) {
    const model::Machine machine = model::parse_machine(text, arguments.machine);
    std::vector<create::PlannedAxis> axes;
    for (const model::Axis& axis : machine.axes)
      if (axis.min && axis.max) axes.push_back({axis.name, *axis.min, *axis.max});
    const create::PlannedAxis& planned = create::plan_stations(axes, words);
    const std::size_t index = *machine.find_axis(planned.name);
    const model::Table table = exchange::table_at(machine, index, planned.stations);
    list.push_back({planned.name, machine.table_of(index)->stations.size(), table.stations.size()});
    text = exchange::set_table(text, machine, table);
  }
  return list;
}

void run_set(const SetArguments& arguments) {
  if (arguments.values.empty() && arguments.artefacts.empty() && arguments.stations.empty() &&
      !arguments.reflector && !arguments.measured_travel)
    throw text::InputError(
        "set: give a value (NAME=NUMBER), --artefact NAME:TYPE, --stations NAME=STEP, --reflector or "
        "--measured-travel");
  std::string text = with_reflector(with_artefacts(text::read_file(arguments.machine), arguments), arguments);
  const std::vector<NewStations> restationed = take_stations(text, arguments);
  model::Machine machine = model::parse_machine(text, arguments.machine);
  std::map<std::string, double> values;
  for (const std::string& word : arguments.values) {
    const auto at = word.rfind('=');
    const auto value = at == std::string::npos ? std::nullopt : text::parse_number(word.substr(at + 1));
    if (!value) throw text::InputError("\"" + word + "\": a value is NAME=NUMBER");
    values[word.substr(0, at)] = *value;
  }
  workbench::set_values(machine, values);
  std::vector<std::size_t> travels;
  if (arguments.measured_travel) travels = take_measured_travel(machine);
  text::write_file(arguments.output, values.empty() && travels.empty()
                                         ? text
                                         : model::update_machine_text(text, machine, true));
  nlohmann::ordered_json json = {{"machine", arguments.output},
                                 {"values", values},
                                 {"artefacts", arguments.artefacts},
                                 {"reflector", arguments.reflector},
                                 {"travels", nlohmann::ordered_json::object()},
                                 {"stations", nlohmann::ordered_json::object()}};
  for (const std::size_t index : travels)
    json["travels"][machine.axes[index].name] = {*machine.axes[index].min, *machine.axes[index].max};
  for (const NewStations& one : restationed) json["stations"][one.axis] = one.after;
  write_json(arguments.json, json);
  for (const NewStations& one : restationed)
    fmt::print(human_stream(arguments.json), "table of {}: {} stations, {} before; fit the machine again\n",
               one.axis, one.after, one.before);
  for (const std::size_t index : travels)
    fmt::print(human_stream(arguments.json), "{}: travel from {:g} to {:g} {}, as measured\n",
               machine.axes[index].name, *machine.axes[index].min, *machine.axes[index].max,
               machine.axes[index].rotary ? "deg" : "mm");
  if (arguments.measured_travel && travels.empty())
    fmt::print(human_stream(arguments.json), "every axis was measured over its whole travel\n");
  for (const auto& [name, value] : values)
    fmt::print(human_stream(arguments.json), "{} = {:.10g}\n", name, value);
  for (const std::string& words : arguments.artefacts)
    fmt::print(human_stream(arguments.json), "artefact {} declared\n", words);
  if (arguments.reflector)
    fmt::print(human_stream(arguments.json),
               "unknown place of the reflector on the tool declared (ToolShift): a fit estimates it\n");
}

}  // namespace

void register_exclude(CLI::App& vernier) {
  auto arguments = std::make_shared<ExcludeArguments>();
  CLI::App* command = vernier.add_subcommand(
      "exclude", "Exclude rows of a measurement by hand, with a reason; or include them again");
  command->add_option("MEAS", arguments->measurement, "measurement file (CSV)")
      ->type_name(kReads)
      ->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "name of the new measurement file; it may be the name of the input file")
      ->type_name(kWrites);
  command->add_option(
      "--lines", arguments->lines,
      "lines of the rows to exclude: 12,15-20; without this option the command lists the excluded rows");
  command->add_option("--reason", arguments->reason, "reason, stored with each row")->capture_default_str();
  command->add_flag("--restore", arguments->restore, "include again the excluded rows on these lines");
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "An excluded row stays in its line as a comment with the reason, so every other row keeps its line "
      "number\n"
      "and all commands accept the file. Exit status 0 done, 1 bad input (nothing written).");
  command->callback([arguments] { run_exclude(*arguments); });
}

void register_set(CLI::App& vernier) {
  auto arguments = std::make_shared<SetArguments>();
  CLI::App* command =
      vernier.add_subcommand("set", "Set parameters of a machine by hand, or declare a touched object");
  command->add_option("MACHINE", arguments->machine, "machine file (XML)")->type_name(kReads)->required();
  command->add_option("VALUES", arguments->values,
                      "new value of a parameter: NAME=NUMBER, with the name as in the result of fit");
  command
      ->add_option(
          "--artefact", arguments->artefacts,
          "touched object to declare in the machine: NAME:TYPE, such as bed:plane; types: point, line, "
          "plane, sphere, cylinder; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--stations", arguments->stations,
          "NAME=STEP or NAME=POSITION,POSITION,...: new stations of the table of an axis, mm or deg, with "
          "the values that the table has there: X=25; the ends of the travel are stations too; may be "
          "repeated")
      ->allow_extra_args(false);
  command->add_flag("--reflector", arguments->reflector,
                    "the readings are those of a reflector at an unknown place on the tool: declare this "
                    "place (ToolShift), which a fit estimates, and which is no error of the machine");
  command->add_flag(
      "--measured-travel", arguments->measured_travel,
      "reduce the travel (min and max) of each axis to the range in which the last fit measured "
      "it: the machine then corrects, and is judged, within this range");
  command->add_option("-o,--output", arguments->output, "the new machine file")
      ->type_name(kWrites)
      ->required();
  command->add_option("--json", arguments->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer("Exit status 0 done, 1 bad input (nothing written).");
  command->callback([arguments] { run_set(*arguments); });
}

}  // namespace vernier::commands::edit_cli
