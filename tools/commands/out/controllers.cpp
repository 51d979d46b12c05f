// SPDX-License-Identifier: GPL-3.0-or-later
// `vernier export siemens|heidenhain|fanuc`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/commands/out/exporting.h"
#include "tools/exchange/controller/controller_files.h"
#include "tools/exchange/controller/placing.h"
#include "tools/exchange/controller/tables.h"
#include "tools/kinematics/at.h"
#include "tools/text/error.h"

namespace vernier::commands::exchange_cli {
namespace {

using exchange::Controller;

struct ControllerArguments {
  ExchangeArguments common;
  std::string reference, numbers;
  double step_mm = 0, unit_um = 1;
};

exchange::ControllerSetting setting_of(const ControllerArguments& arguments) {
  exchange::ControllerSetting setting;
  setting.unit_um = arguments.unit_um;
  if (arguments.numbers.empty()) return setting;
  const std::vector<double> numbers = kinematics::number_list(arguments.numbers, {3}, "--numbers");
  for (std::size_t i = 0; i < 3; ++i) {
    constexpr double kMost = 99;
    if (numbers[i] != std::floor(numbers[i]) || numbers[i] < 1 || numbers[i] > kMost)
      throw text::InputError(
          fmt::format("--numbers: '{}' must be three numbers from 1 to 99", arguments.numbers));
    setting.number[i] = static_cast<int>(numbers[i]);
  }
  return setting;
}

/// Position of the reference: stated, else 0, else the end of the range nearest to 0.
exchange::ControllerWishes wishes_of(const ControllerArguments& arguments, const exchange::ThreeAxes& axes) {
  exchange::ControllerWishes wishes{arguments.common.tolerance_um, arguments.step_mm, {}};
  for (std::size_t i = 0; i < 3; ++i) wishes.reference[i] = std::clamp(0.0, axes.low[i], axes.high[i]);
  if (arguments.reference.empty()) return wishes;
  const std::vector<double> stated = kinematics::number_list(arguments.reference, {3}, "--reference");
  for (std::size_t i = 0; i < 3; ++i) {
    if (stated[i] < axes.low[i] || stated[i] > axes.high[i])
      throw text::InputError(fmt::format("--reference: {} of {} is outside its range from {} to {} mm",
                                         stated[i], exchange::kLetters[i], axes.low[i], axes.high[i]));
    wishes.reference[i] = stated[i];
  }
  return wishes;
}

/// What remains in the state of the export, and the inputs, speeds and times that no table holds.
std::vector<exchange::LeftOut> left_out_of(const model::Machine& machine, const exchange::ThreeAxes& axes,
                                           const model::States& at, const exchange::ControllerErrors& errors,
                                           const exchange::ControllerTables& tables) {
  std::vector<exchange::LeftOut> left = remaining(errors.after_um);
  for (const exchange::UncertainShape& one : tables.uncertain)
    left.push_back(
        {fmt::format("straightness of {} along {} beside its straight line, because the readings do "
                     "not determine it (uncertainty {:.3g} um rms): rms of the model",
                     exchange::kLetters[one.output], exchange::kLetters[one.input], one.std_um),
         one.um});
  for (const std::size_t axis : axes.axis)
    for (exchange::LeftOut& one : exchange::beyond_own_axis(machine, axis, at))
      if (!one.other_axis) left.push_back(std::move(one));
  return left;
}

Json result_json(const exchange::ControllerErrors& errors, const exchange::ControllerTables& tables) {
  Json written = Json::array();
  for (const exchange::ControllerTable& table : tables.tables)
    written.push_back({{"input", exchange::kLetters[table.input]},
                       {"output", exchange::kLetters[table.output]},
                       {"points", table.forward.size()},
                       {"step_mm", table.step}});
  return {{"tables", written},
          {"between_um", three_json(tables.between_um)},
          {"reversal_um",
           three_json({1000 * tables.reversal[0], 1000 * tables.reversal[1], 1000 * tables.reversal[2]})},
          {"errors",
           {{"positions", errors.positions},
            {"before_um", three_json(errors.before_um)},
            {"after_um", three_json(errors.after_um)},
            {"after_positive_um", three_json(errors.after_positive_um)},
            {"after_negative_um", three_json(errors.after_negative_um)},
            {"rms_before_um", errors.rms_before_um},
            {"rms_after_um", errors.rms_after_um},
            {"rotation_um", errors.rotation_um},
            {"rotation_urad", three_json(errors.rotation_urad)}}}};
}

void print_tables(const ExchangeArguments& common, const exchange::ControllerTables& tables,
                  const exchange::ControllerErrors& errors) {
  std::FILE* out = human_stream(common.json);
  for (const exchange::ControllerTable& table : tables.tables)
    fmt::print(out, "{} by the position of {}: {} points, {:.6g} mm apart\n",
               exchange::kLetters[table.output], exchange::kLetters[table.input], table.forward.size(),
               table.step);
  for (std::size_t i = 0; i < 3; ++i)
    if (tables.between_um[i] > common.tolerance_um)
      fmt::print(out, "note: the error between the points of {} is {:.3g} um, the tolerance is {} um\n",
                 exchange::kLetters[i], tables.between_um[i], common.tolerance_um);
  std::string without_reversal;
  for (const exchange::ControllerTable& table : tables.tables)
    if (table.input == table.output && tables.reversal[table.input] == 0 &&
        (table.reverse.empty() || table.reverse == table.forward))
      without_reversal +=
          (without_reversal.empty() ? "" : ", ") + std::string(exchange::kLetters[table.input]);
  if (!without_reversal.empty())
    fmt::print(
        out,
        "note: the model has no reversal error of {}: the files set the backlash of the control to 0. If "
        "the control compensated a backlash in the measurement, keep its value\n",
        without_reversal);
  for (std::size_t i = 0; i < 3; ++i)
    if (errors.after_um[i] > errors.before_um[i] + exchange::kNothing_um)
      fmt::print(out, "note: the files increase the largest error along {} from {:.3g} to {:.3g} um\n",
                 exchange::kLetters[i], errors.before_um[i], errors.after_um[i]);
}

/// Says that the files correct a rotation of the whole part: it may be the alignment of the instrument.
void print_rotation(const ExchangeArguments& common, const exchange::ControllerErrors& errors) {
  constexpr double kVisible_um = 0.1;  // the finest digit in the tables of controllers
  if (errors.rotation_um < kVisible_um) return;
  fmt::print(
      human_stream(common.json),
      "the files contain a rotation of the whole part: up to {:.3g} um in the working volume (about X, Y, "
      "Z: {:.3g}, {:.3g}, {:.3g} urad). The rotation can be the alignment of the instrument, and no "
      "dimension of a part depends on it.\n",
      errors.rotation_um, errors.rotation_urad[0], errors.rotation_urad[1], errors.rotation_urad[2]);
}

void export_controller(const ControllerArguments& arguments, Controller controller, const char* name) {
  const ExchangeArguments& common = arguments.common;
  const model::Machine machine = read_model(common.machine);
  const exchange::ControllerSetting setting = setting_of(arguments);
  const exchange::ThreeAxes axes = exchange::three_axes(machine);
  const exchange::ControllerWishes wishes = wishes_of(arguments, axes);
  const model::States at = state_of(machine, common);
  require_safe(machine, common);
  exchange::ControllerTables tables =
      exchange::controller_tables(machine, axes, exchange::rules_of(controller, setting), at, wishes);
  const std::vector<exchange::ConfigurationFile> texts =
      exchange::controller_files(controller, setting, machine.name, tables);
  const exchange::ControllerErrors errors = exchange::controller_errors(machine, axes, tables, at);
  refuse_without_errors(common, errors.rms_before_um);
  const Json files = write_folder(common, texts);
  print_tables(common, tables, errors);
  print_rms(common, errors.positions, errors.rms_before_um, errors.rms_after_um);
  print_rotation(common, errors);
  finish(machine, common, name, left_out_of(machine, axes, at, errors, tables), files, {}, true,
         result_json(errors, tables));
}

void add_controller(CLI::App* parent, const char* name, const char* what, Controller controller) {
  auto arguments = std::make_shared<ControllerArguments>();
  arguments->common.tolerance_um = 1;
  CLI::App* command = add_export(parent, name, what, kWritesFolder, "directory",
                                 std::shared_ptr<ExchangeArguments>(arguments, &arguments->common));
  command
      ->add_option("--step", arguments->step_mm,
                   "distance between two points of a table, mm; default: the largest distance that "
                   "--tolerance permits")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--tolerance", arguments->common.tolerance_um,
                   "largest permitted interpolation error between two points of a table, um")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--reference", arguments->reference,
                   "machine positions at which the corrections are zero (reference points), mm; default: 0, "
                   "or the end of the axis range that is nearest to 0")
      ->type_name("X,Y,Z");
  if (controller != Controller::kHeidenhain)
    command
        ->add_option("--numbers", arguments->numbers, "numbers of the machine axes X, Y and Z; default 1,2,3")
        ->type_name("X,Y,Z");
  if (controller == Controller::kFanuc)
    command->add_option("--unit", arguments->unit_um, "detection unit, um")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
  command->footer(
      "The command writes the corrections that the tables of the controller can express, and prints the "
      "remaining error,\n"
      "evaluated on the chain between the points in both directions, without offsets of the axes. The files "
      "were not\n"
      "tried on a controller: do the test moves that the files describe before you cut with the tables.");
  command->callback([arguments, controller, name] { export_controller(*arguments, controller, name); });
}

}  // namespace

void add_controller_exports(CLI::App* parent) {
  add_controller(parent, "siemens", "SINUMERIK 840D, ONE: ENC_COMP, CEC and backlash", Controller::kSiemens);
  add_controller(parent, "heidenhain", "HEIDENHAIN: nonlinear axis error compensation (.COM, .CMA)",
                 Controller::kHeidenhain);
  add_controller(parent, "fanuc", "FANUC: stored pitch error compensation and backlash", Controller::kFanuc);
}

}  // namespace vernier::commands::exchange_cli
