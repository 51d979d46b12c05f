// SPDX-License-Identifier: GPL-3.0-or-later
// `vernier export urdf`.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "tools/commands/command.h"
#include "tools/commands/fit_findings.h"
#include "tools/commands/out/exporting.h"
#include "tools/exchange/tip_link.h"
#include "tools/exchange/urdf_arm.h"
#include "tools/text/files.h"

namespace vernier::commands::exchange_cli {
namespace {

void export_urdf(const ExchangeArguments& arguments) {
  const model::Machine machine = read_model(arguments.machine);
  const model::States at = state_of(machine, arguments);
  require_safe(machine, arguments, true);
  std::optional<exchange::UrdfOriginal> original;
  if (!arguments.original.empty())
    original = {text::read_file(arguments.original), arguments.original, arguments.tip};
  const exchange::UrdfFile file =
      exchange::urdf_arm(machine, at, exchange::joint_names(machine, text::read_file(arguments.machine)),
                         original ? &*original : nullptr);
  const Json files = write_folder(arguments, {{"robot.urdf", file.text}});
  std::vector<exchange::LeftOut> left;
  if (file.worst_um > exchange::kNothing_um)
    left.push_back({"effect on the tool point of errors that depend on the joint angles", file.worst_um});
  fmt::print(human_stream(arguments.json),
             "difference from the machine file at {} poses in the {} ranges of the axes: distance of the "
             "tool point rms {:.3g} um, up to {:.3g} um, tool direction up to {:.3g} urad; without the "
             "calibration (the nominal arm, with the best base and tool point): rms {:.3g} um\n",
             file.positions, file.measured ? "measured" : "declared", file.rms_um, file.worst_um,
             file.worst_urad, file.rms_nominal_um);
  Json tip;
  if (!file.original) {
    fmt::print(
        human_stream(arguments.json),
        "base_link is the base of the rows of the machine file; the root link of the URDF from which the "
        "machine was made can have another place and orientation (--original keeps it)\n");
  } else {
    std::array<double, 3> tool = file.original->tool_mm;
    constexpr double kShown_mm = 5e-5;  // of the digits below: no minus before a zero
    for (double& one : tool) one = std::abs(one) < kShown_mm ? 0 : one;
    fmt::print(
        human_stream(arguments.json),
        "the joints of {} are {} up to the link {}{}; the tool point of the machine file is at "
        "{:.4f}, {:.4f}, {:.4f} mm in this link\n",
        arguments.original,
        machine.fitted ? "calibrated" : "those of the machine file, which no fit wrote (not calibrated),",
        file.original->tip,
        file.original->added_tip ? " (new, because the last joint of the arm ends at the tip)" : "", tool[0],
        tool[1], tool[2]);
    tip = {{"link", file.original->tip}, {"added", file.original->added_tip}, {"tool_mm", three_json(tool)}};
  }
  // The place of a reflector, in a link of the URDF that the user gets.
  const std::optional<exchange::TipLink> link = original
                                                    ? exchange::tip_link(text::read_file(arguments.machine))
                                                    : exchange::tool_link(machine, exchange::kToolLink);
  if (link && !machine.tool_shifts.empty()) {
    for (const std::string& one :
         exchange::tool_shift_places(machine, *link, original ? "the URDF" : "robot.urdf"))
      fmt::print(human_stream(arguments.json), "{}\n", one);
    fmt::print(human_stream(arguments.json),
               "the readings do not show where the flange ends: an error of the flange's length or offset is "
               "in the place of the reflector; measure the place of a tool from the reflector\n");
  }
  Json undetermined = Json::array();
  for (const exchange::UndeterminedJoint& one : file.undetermined)
    undetermined.push_back({{"joint", one.joint}, {"parameters", one.parameters}});
  if (!file.undetermined.empty())
    fmt::print(human_stream(arguments.json),
               "not determined by the readings of the fit, values set by convention or prior: {}; do not use "
               "the values of one of these joints alone\n",
               exchange::joints_text(file.undetermined));
  finish(machine, arguments, "urdf", left, files, {}, true,
         {{"tip", tip},
          {"errors",
           {{"positions", file.positions},
            {"in_measured_ranges", file.measured},
            {"rms_before_um", file.rms_nominal_um},
            {"rms_after_um", file.rms_um},
            {"after_um", file.worst_um},
            {"after_urad", file.worst_urad}}},
          {"undetermined_joints", undetermined}});
}

}  // namespace

void add_robot_exports(CLI::App* parent) {
  auto arguments = std::make_shared<ExchangeArguments>();
  CLI::App* command = add_export(parent, "urdf", "URDF: the calibrated joints of an arm (ROS)", kWritesFolder,
                                 "directory", arguments);
  command
      ->add_option("--original", arguments->original,
                   "URDF from which the machine file was made: keep its links, meshes, limits and names, "
                   "and change the origins of its joints only")
      ->type_name(kReads);
  command->add_option("--tip", arguments->tip, "end link in this URDF (default: its only end link)")
      ->type_name("LINK")
      ->needs("--original");
  command->footer(
      "The command writes robot.urdf with a joint for each axis. The origins and axes of the joints are "
      "fitted to the machine\n"
      "file in the measured ranges of the axes. The command prints the part of compliance, cyclic errors, "
      "reversal and thermal\n"
      "errors that ideal joints cannot express.");
  command->callback([arguments] { export_urdf(*arguments); });
}

}  // namespace vernier::commands::exchange_cli
